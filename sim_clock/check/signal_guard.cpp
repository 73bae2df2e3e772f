#include "sim_clock/check/signal_guard.hpp"

#include <cstring>

#include <fmt/format.h>

#include "sim_clock/check/self_check.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

// Leaves the handler by a switch of contexts, back to where the execution was started; the task is dropped
// where it stands. Formatting here allocates. That is safe unless the signal came from inside malloc, where
// the program is lost anyway.
void on_signal(int signal, siginfo_t* details, void* /*context*/) {
  Task* const task = current_task;
  if (task == nullptr) {
    ::signal(signal, SIG_DFL);
    raise(signal);
    return;
  }
  const GhostScope ghost;
  const bool overflow = signal == SIGSEGV && task->storage->on_guard(details->si_addr);
  task->world->scheduler().fail(
      OutcomeKind::crash,
      overflow ? fmt::format("{}: stack overflow ({} bytes)", task->name, TaskStorage::stack_bytes)
               : fmt::format("{}: {} (SIG{})", task->name, strsignal(signal), sigabbrev_np(signal)));
}

}  // namespace

SignalGuard::SignalGuard() : stack_(64 * 1024) {
  const stack_t stack{.ss_sp = stack_.data(), .ss_flags = 0, .ss_size = stack_.size()};
  LTSIM_CHECK(sigaltstack(&stack, &previous_stack_) == 0);
  struct sigaction action{};
  action.sa_sigaction = &on_signal;
  action.sa_flags =
      SA_SIGINFO | SA_ONSTACK | SA_NODEFER;  // the handler is not returned from: nothing may stay blocked
  for (std::size_t i = 0; i < guarded_signals.size(); ++i) {
    LTSIM_CHECK(sigaction(guarded_signals[i], &action, &previous_actions_[i]) == 0);
  }
}

SignalGuard::~SignalGuard() {
  for (std::size_t i = 0; i < guarded_signals.size(); ++i)
    sigaction(guarded_signals[i], &previous_actions_[i], nullptr);
  sigaltstack(&previous_stack_, nullptr);
}

}  // namespace ltsim
