// One processor. A thread of low priority holds the lock of the bus, the bus thread of high priority waits for it, and
// threads in between, which need no lock, keep the low one from ever giving it back (Mars Pathfinder 1997).

#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "sim_clock/scenario/shape.hpp"

namespace {

using Microseconds = std::chrono::microseconds;

void become(int priority) {
  const sched_param parameters{.sched_priority = priority};
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
}

/// Computes for some microseconds; `at_each_step` is called five times in each.
template <typename AtEachStep>
void compute(int microseconds, AtEachStep at_each_step) {
  std::atomic<int> result{0};  // a load and a store of 100 ns each
  for (int step = 0; step < 5 * microseconds; ++step) {
    result = result + step;
    at_each_step();
  }
}

class BusLock {
 public:
  explicit BusLock(int protocol) {
    pthread_mutexattr_t attributes;
    pthread_mutexattr_init(&attributes);
    pthread_mutexattr_setprotocol(&attributes, protocol);
    pthread_mutex_init(&mutex_, &attributes);
  }
  void lock() { pthread_mutex_lock(&mutex_); }
  void unlock() { pthread_mutex_unlock(&mutex_); }

 private:
  pthread_mutex_t mutex_;
};

}  // namespace

SHAPE("races/o12-priority-inversion",
      {.finding = "I15",
       .depth = 2,
       .tasks_count = 3,
       .cure = "who holds the lock inherits the priority of who waits"},
      "a thread of middle priority keeps the highest from a lock") {
  world.set_cpu(ltsim::Cpu::one_fifo);
  const ltsim::Task* bus = nullptr;
  const ltsim::Task* weather = nullptr;
  bool bus_locks = false;

  world.process("rover").start("main", [&] {
    BusLock lock{corrected ? PTHREAD_PRIO_INHERIT : PTHREAD_PRIO_NONE};
    std::thread bus_thread{[&] {
      become(3);
      bus = ltsim::current_task;
      for (int cycle = 0; cycle < 3; ++cycle) {
        std::this_thread::sleep_for(Microseconds{125});
        bus_locks = true;
        lock.lock();
        bus_locks = false;
        compute(1, [] {});
        lock.unlock();
      }
    }};
    std::thread communication_thread{[&] {
      become(2);
      for (int message = 0; message < 3; ++message) {
        std::this_thread::sleep_for(Microseconds{100});
        compute(5, [&] {
          const bool bus_waits = bus_locks && bus->state == ltsim::Task::State::blocked;
          // Who is held up, and does not merely wait for its turn, would not run in any case.
          world.require(
              !bus_waits || weather->state != ltsim::Task::State::runnable,
              "I15: the bus thread waits for the lock, and the thread that holds it for the processor");
        });
      }
    }};
    std::thread weather_thread{[&] {
      become(1);
      weather = ltsim::current_task;
      for (int measurement = 0; measurement < 3; ++measurement) {
        lock.lock();
        compute(2, [] {});
        lock.unlock();
        std::this_thread::sleep_for(Microseconds{80});
      }
    }};
    bus_thread.join();
    communication_thread.join();
    weather_thread.join();
  });
  world.run();
}
