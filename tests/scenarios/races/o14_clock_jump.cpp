// A timed wait runs on wall time. Somebody sets the clock, and it ends long before its time (jack2 #224, raspberrypi
// userland #658, sysrepo #2372).

#include <fcntl.h>
#include <semaphore.h>

#include <chrono>
#include <ctime>
#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

constexpr races::Milliseconds timeout{200};

/// What the clock will show when the time-out has passed.
timespec deadline_on(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  const auto deadline = std::chrono::seconds{now.tv_sec} + std::chrono::nanoseconds{now.tv_nsec} + timeout;
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(deadline);
  return {.tv_sec = seconds.count(), .tv_nsec = (deadline - seconds).count()};
}

}  // namespace

SHAPE("races/o14-clock-jump",
      {.finding = "I16", .depth = 1, .tasks_count = 2, .cure = "the wait runs on the monotonic clock"},
      "the wall clock is set while a time-out runs on it") {
  world.grant(ltsim::FaultKind::clock_step, 1);

  world.process("emulator").start("main", [] {
    sem_t* const answer_bell = sem_open("/answer", O_CREAT, 0600, 0);
    std::this_thread::sleep_for(races::Milliseconds{100});
    sem_post(answer_bell);
  });
  world.process("kernel").start("main", [&] {
    sem_t* const answer_bell = sem_open("/answer", O_CREAT, 0600, 0);
    const ltsim::SimTime begin = world.now();
    const clockid_t clock = corrected ? CLOCK_MONOTONIC : CLOCK_REALTIME;
    const timespec deadline = deadline_on(clock);
    const int result = sem_clockwait(answer_bell, clock, &deadline);
    world.require(result == 0 || world.now() - begin >= timeout,
                  "I16: a time-out is reported before its time");
  });
  world.run();
}
