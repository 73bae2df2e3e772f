#include "sim_clock/scenario/interrupt.hpp"

#include <sys/syscall.h>
#include <time.h>

#include <atomic>
#include <cstdint>

namespace ltsim {
namespace {

// timeout(1) sends its signal to the program and at once again to all of its group: that is one request.
constexpr std::int64_t nanoseconds_of_one_request = 1'000'000'000;

volatile std::sig_atomic_t signal_that_came = 0;
std::atomic<std::int64_t> came_at = 0;  // by the monotonic clock, in nanoseconds
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "a signal handler uses it");

// By the system itself: clock_gettime() is this program's own (takeover/clocks.cpp), and would be a step of the simulated task that
// the signal has interrupted.
std::int64_t monotonic_nanoseconds() {
  timespec now{};
  long result = SYS_clock_gettime;
  asm volatile("syscall"
               : "+a"(result)
               : "D"(static_cast<long>(CLOCK_MONOTONIC)), "S"(&now)
               : "rcx", "r11", "memory");
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// Only calls that POSIX allows in a signal handler.
void note(int signal) {
  if (signal_that_came == 0) {
    came_at = monotonic_nanoseconds();
    signal_that_came = signal;
  } else if (monotonic_nanoseconds() - came_at > nanoseconds_of_one_request) {
    ::signal(signal, SIG_DFL);
    raise(signal);
  }
}

}  // namespace

InterruptGuard::InterruptGuard() {
  signal_that_came = 0;
  struct sigaction action{};
  action.sa_handler = &note;
  sigaddset(&action.sa_mask, SIGINT);
  sigaddset(&action.sa_mask, SIGTERM);
  sigaction(SIGINT, &action, &previous_int_);
  sigaction(SIGTERM, &action, &previous_term_);
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &previous_int_, nullptr);
  sigaction(SIGTERM, &previous_term_, nullptr);
}

int InterruptGuard::signal() noexcept { return signal_that_came; }

}  // namespace ltsim
