// Turns a signal that the code under test causes (a bad address, a division by zero, libc's own abort after a
// double free) into the outcome `crash` of its execution. A signal outside a simulated task is ours, and ends
// the program as it always would.
#pragma once

#include <array>
#include <csignal>
#include <cstddef>
#include <vector>

namespace ltsim {

/// While it lives, SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGABRT are guarded. One at a time.
class SignalGuard {
 public:
  SignalGuard();
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

 private:
  static constexpr std::array<int, 5> guarded_signals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

  std::vector<std::byte> stack_;  // a stack overflow leaves no room on the task's own
  stack_t previous_stack_{};
  std::array<struct sigaction, guarded_signals.size()> previous_actions_{};
};

}  // namespace ltsim
