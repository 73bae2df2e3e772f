// For tests of single calls: small pieces that most of them need.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <functional>
#include <initializer_list>
#include <string>
#include <thread>

#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {

using namespace std::chrono_literals;

class CallsTest : public WorldTest {
 protected:
  /// One task, p/main, under the default strategy.
  static Outcome run_task(const std::function<void(World&)>& body) {
    return run([&body](World& world) { world.process("p").start("main", [&] { body(world); }); });
  }

  /// How many of the tasks of process p wait.
  static std::size_t blocked_count(const World& world, std::initializer_list<const char*> tasks) {
    std::size_t count = 0;
    for (const char* const task : tasks) count += world.blocked_in(std::string{"p/"} + task).empty() ? 0 : 1;
    return count;
  }

  /// What the clock will show when `duration` has passed.
  static timespec in(SimTime duration, clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    const SimTime sum = std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec} + duration;
    return {.tv_sec = sum / 1s, .tv_nsec = (sum % 1s).count()};
  }

  /// Whether `duration` has passed since `begin`, and no more but what the scheduling points between cost.
  static bool took(const World& world, SimTime begin, SimTime duration) {
    const SimTime passed = world.now() - begin;
    return passed >= duration && passed < duration + 20us;
  }

  /// What a thread of its own finds when it tries to lock.
  template <typename Mutex>
  static bool another_could_lock(Mutex& mutex) {
    bool could = false;
    std::thread{[&] {
      could = mutex.try_lock();
      if (could) mutex.unlock();
    }}.join();
    return could;
  }

  static void* map_segment() {
    const int descriptor = shm_open("/segment", O_CREAT | O_RDWR, 0600);
    if (ftruncate(descriptor, 4096) != 0) return nullptr;
    return mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  }
};

}  // namespace ltsim
