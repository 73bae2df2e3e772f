// Clocks, sleeping and sched_yield(2).

#include <sched.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

namespace {

/// @return what is left if it was interrupted, otherwise 0
std::chrono::nanoseconds sleep_for(std::chrono::nanoseconds duration) noexcept {
  ltsim::World& world = *current_task->world;
  const auto longest = ltsim::VirtualClock::never - world.now();
  return world.sleep_until(world.now() + std::min(duration, longest));
}

/// The numbered clocks of <linux/time.h>; dynamic ones (devices, other processes) are not simulated.
bool is_known(clockid_t clock) noexcept { return clock >= CLOCK_REALTIME && clock <= CLOCK_TAI; }

bool is_valid(const timespec& time) noexcept {
  return time.tv_sec >= 0 && time.tv_nsec >= 0 && time.tv_nsec < 1'000'000'000;
}

/// Longer sleeps than the clock can count are cut: 200 years.
std::chrono::nanoseconds to_duration(const timespec& time) noexcept {
  constexpr time_t seconds_max = 200LL * 365 * 24 * 3600;
  return std::chrono::seconds{time.tv_sec < seconds_max ? time.tv_sec : seconds_max} +
         std::chrono::nanoseconds{time.tv_nsec};
}

/// @param remaining  null, or where to put what is left after an interrupt
/// @return           0, or EINTR
int sleep_for(const timespec& duration, timespec* remaining) noexcept {
  const auto left = sleep_for(to_duration(duration));
  if (left.count() == 0) return 0;
  const auto seconds = std::chrono::floor<std::chrono::seconds>(left);
  if (remaining != nullptr) *remaining = {.tv_sec = seconds.count(), .tv_nsec = (left - seconds).count()};
  return EINTR;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* into) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(clock_gettime)(clock, into);
  if (!is_known(clock)) {
    errno = EINVAL;
    return -1;
  }
  *into = current_task->world->read_clock(clock);
  return 0;
}

extern "C" int gettimeofday(timeval* into, void* zone) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(gettimeofday)(into, zone);
  const timespec time = current_task->world->read_clock(CLOCK_REALTIME);
  *into = {.tv_sec = time.tv_sec, .tv_usec = time.tv_nsec / 1000};
  return 0;
}

extern "C" int timespec_get(timespec* into, int base) noexcept {
  if (current_task == nullptr || base != TIME_UTC) return LTSIM_NEXT(timespec_get)(into, base);
  *into = current_task->world->read_clock(CLOCK_REALTIME);
  return base;
}

extern "C" time_t time(time_t* into) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(time)(into);
  const time_t seconds = current_task->world->read_clock(CLOCK_REALTIME).tv_sec;
  if (into != nullptr) *into = seconds;
  return seconds;
}

extern "C" int nanosleep(const timespec* duration, timespec* remaining) {
  if (current_task == nullptr) return LTSIM_NEXT(nanosleep)(duration, remaining);
  if (!is_valid(*duration)) {
    errno = EINVAL;
    return -1;
  }
  const int error = sleep_for(*duration, remaining);
  if (error == 0) return 0;
  errno = error;
  return -1;
}

extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* remaining) {
  if (current_task == nullptr) return LTSIM_NEXT(clock_nanosleep)(clock, flags, time, remaining);
  if (!is_valid(*time) || !is_known(clock)) return EINVAL;
  if ((flags & TIMER_ABSTIME) == 0) return sleep_for(*time, remaining);
  ltsim::World& world = *current_task->world;
  return world.sleep_until(world.to_deadline(clock, *time)).count() == 0 ? 0 : EINTR;
}

extern "C" int usleep(useconds_t microseconds) {
  if (current_task == nullptr) return LTSIM_NEXT(usleep)(microseconds);
  if (sleep_for(std::chrono::microseconds{microseconds}).count() == 0) return 0;
  errno = EINTR;
  return -1;
}

extern "C" unsigned sleep(unsigned seconds) {
  if (current_task == nullptr) return LTSIM_NEXT(sleep)(seconds);
  const auto left = std::chrono::floor<std::chrono::seconds>(sleep_for(std::chrono::seconds{seconds}));
  return static_cast<unsigned>(left.count());
}

extern "C" int sched_yield() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(sched_yield)();
  current_task->world->scheduler().point({.kind = ltsim::OperationKind::yield});
  return 0;
}
