// Steps of the wall clock: who sees them, and whose waits they move.

#include <pthread.h>
#include <semaphore.h>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <ctime>
#include <mutex>
#include <thread>

#include "tests/sim_clock/faults_fixture.hpp"

namespace ltsim {
namespace {

bool is_about(SimTime measured, SimTime expected) {
  return measured >= expected - 20us && measured <= expected + 20us;
}

/// Reads the clock without asking for a step of it.
SimTime monotonic() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return to_time(time);
}

constexpr time_t begin_of_world = 1'767'225'600;  // 2026-01-01T00:00:00Z

TEST_F(FaultsTest, a_step_of_the_wall_clock_is_seen_by_those_who_read_it_and_by_no_other_clock) {
  EXPECT_EQ(run_with({"fault p/main before clock_read - #2 clock-step 3",
                      "fault p/main before clock_read - #4 clock-step 6"},
                     [](World& world) {
                       world.grant(FaultKind::clock_step, 2);
                       world.process("p").start("main", [&world] {
                         world.require(time(nullptr) == begin_of_world, "as it was");
                         world.require(time(nullptr) == begin_of_world + 3600, "an hour forward");
                         world.require(monotonic() < 1ms, "but not here");
                         world.require(time(nullptr) == begin_of_world + 3540, "a minute back");
                       });
                       world.run();
                     }),
            Outcome{});
}

/// Waits 10 s by the wall clock in each of the ways that there are, and says how long each took.
std::array<SimTime, 4> wait_by_the_wall_clock(World& world) {
  std::array<SimTime, 4> took{};
  const auto measure = [&](std::size_t i, const auto& wait) {
    const timespec deadline{.tv_sec = begin_of_world + 10 * static_cast<time_t>(i + 1), .tv_nsec = 0};
    const SimTime begin = world.now();
    wait(deadline);
    took[i] = world.now() - begin;
  };
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
  measure(0, [](const timespec& deadline) { sem_timedwait(open_semaphore(), &deadline); });
  measure(1, [](const timespec& deadline) {
    clock_nanosleep(CLOCK_REALTIME, TIMER_ABSTIME, &deadline, nullptr);
  });
  pthread_mutex_lock(&mutex);
  measure(2, [&](const timespec& deadline) { pthread_cond_timedwait(&condition, &mutex, &deadline); });
  std::thread{[&] {
    measure(3, [&](const timespec& deadline) { pthread_mutex_timedlock(&mutex, &deadline); });
  }}.join();
  pthread_mutex_unlock(&mutex);
  return took;
}

TEST_F(FaultsTest, a_wait_that_ends_by_the_wall_clock_ends_later_when_the_clock_is_set_back) {
  EXPECT_EQ(
      run_with({"fault p/main in sem_timedwait s #1 clock-step 6", "fault p/main in sleep - #1 clock-step 6",
                "fault p/main in cond_timedwait mutex-1 #1 clock-step 6",
                "fault p/thread-1 in mutex_timedlock mutex-1 #1 clock-step 6"},
               [](World& world) {
                 world.grant(FaultKind::clock_step, 4);
                 world.process("p").start("main", [&world] {
                   for (const SimTime took : wait_by_the_wall_clock(world))
                     world.require(is_about(took, 70s), "10 s and a minute");
                 });
                 world.run();
               }),
      Outcome{});
}

TEST_F(FaultsTest, a_wait_that_ends_by_the_wall_clock_ends_at_once_when_the_clock_passes_its_end) {
  EXPECT_EQ(run_with({"fault p/main in sem_timedwait s #1 clock-step 2"},
                     [](World& world) {
                       world.grant(FaultKind::clock_step, 1);
                       world.process("p").start("main", [&world] {
                         for (const SimTime took : wait_by_the_wall_clock(world))
                           world.require(is_about(took, 0s), "a minute was gone, and with it each end");
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(FaultsTest, a_step_that_another_task_sees_moves_the_waits_of_all) {
  EXPECT_EQ(run_with({"fault p/other before clock_read - #1 clock-step 5"},
                     [](World& world) {
                       world.grant(FaultKind::clock_step, 1);
                       world.process("p").start("main", [&world] {
                         const timespec deadline{.tv_sec = begin_of_world + 10, .tv_nsec = 0};
                         world.require(sem_timedwait(open_semaphore(), &deadline) == -1, "nobody posts");
                         world.require(is_about(world.now(), 11s), "a second later");
                       });
                       world.process("p").start("other", [] {
                         usleep(1000);
                         static_cast<void>(time(nullptr));
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(FaultsTest, waits_by_the_monotonic_clock_and_for_a_duration_do_not_heed_the_wall_clock) {
  EXPECT_EQ(run_with({"fault p/other before clock_read - #1 clock-step 4"},
                     [](World& world) {
                       std::mutex mutex;
                       std::condition_variable condition;
                       world.grant(FaultKind::clock_step, 1);
                       world.process("p").start("sleeps", [&world] {
                         std::this_thread::sleep_for(10s);
                         world.require(is_about(world.now(), 10s), "sleep_for");
                       });
                       world.process("p").start("waits", [&] {
                         std::unique_lock lock{mutex};
                         condition.wait_for(lock, 10s);
                         world.require(is_about(world.now(), 10s), "wait_for");
                       });
                       world.process("p").start("other", [] {
                         usleep(1000);
                         static_cast<void>(time(nullptr));
                       });
                       world.run();
                     }),
            Outcome{});
}

}  // namespace
}  // namespace ltsim
