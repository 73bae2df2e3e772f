// Clocks, sleeping and sched_yield(2). What of processors a process has used is all the time that has passed.

#include <sched.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/times.h>
#include <threads.h>
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

// thrd_sleep(3) has results of its own: -1 where it was interrupted, and less for an error.
extern "C" int thrd_sleep(const timespec* duration, timespec* remaining) {
  if (current_task == nullptr) return LTSIM_NEXT(thrd_sleep)(duration, remaining);
  if (!is_valid(*duration)) return -2;
  return sleep_for(*duration, remaining) == 0 ? 0 : -1;
}

extern "C" void thrd_yield() {
  if (current_task == nullptr) return LTSIM_NEXT(thrd_yield)();
  current_task->world->scheduler().point({.kind = ltsim::OperationKind::yield});
}

extern "C" clock_t clock() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(clock)();
  const timespec time = current_task->world->read_clock(CLOCK_PROCESS_CPUTIME_ID);
  return time.tv_sec * CLOCKS_PER_SEC + time.tv_nsec / (1'000'000'000 / CLOCKS_PER_SEC);
}

extern "C" clock_t times(tms* into) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(times)(into);
  constexpr long ticks_per_second = 100;  // sysconf(_SC_CLK_TCK) of Linux
  const timespec time = current_task->world->read_clock(CLOCK_PROCESS_CPUTIME_ID);
  const clock_t ticks = time.tv_sec * ticks_per_second + time.tv_nsec / (1'000'000'000 / ticks_per_second);
  if (into != nullptr) *into = {.tms_utime = ticks, .tms_stime = 0, .tms_cutime = 0, .tms_cstime = 0};
  return ticks;
}

extern "C" int getrusage(__rusage_who_t who, rusage* into) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(getrusage)(who, into);
  if (who != RUSAGE_SELF && who != RUSAGE_CHILDREN && who != RUSAGE_THREAD) {
    errno = EINVAL;
    return -1;
  }
  *into = {};
  if (who == RUSAGE_CHILDREN) return 0;
  const timespec time = current_task->world->read_clock(CLOCK_PROCESS_CPUTIME_ID);
  into->ru_utime = {.tv_sec = time.tv_sec, .tv_usec = time.tv_nsec / 1000};
  return 0;
}
