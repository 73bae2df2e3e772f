// Signals that are waited for. A handler would have to interrupt a task wherever it stands: who installs one is refused.

#include <signal.h>

#include <cerrno>
#include <ctime>

#include <fmt/format.h>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;
using ltsim::Signals;
using ltsim::World;

namespace {

bool is_signal(int signal) noexcept { return signal >= 1 && signal <= Signals::signal_max; }

/// @return  whether it could be done; errno is set otherwise
bool set_disposition(const char* call, int signal, sighandler_t handler) noexcept {
  if (!is_signal(signal) || signal == SIGKILL || signal == SIGSTOP) {
    errno = EINVAL;
    return false;
  }
  World& world = *current_task->world;
  if (handler != SIG_IGN && handler != SIG_DFL)
    world.unsupported(fmt::format(
        "{} called {} with a handler, which ltsim does not simulate: block the signal and wait for it "
        "with sigwait(3)",
        current_task->name, call));
  world.signals().ignore(current_task->process, signal, handler == SIG_IGN);
  return true;
}

}  // namespace

extern "C" int pthread_sigmask(int how, const sigset_t* set, sigset_t* before) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_sigmask)(how, set, before);
  return current_task->world->signals().change_mask(how, set, before);
}

extern "C" int sigprocmask(int how, const sigset_t* set, sigset_t* before) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(sigprocmask)(how, set, before);
  const int error = current_task->world->signals().change_mask(how, set, before);
  if (error == 0) return 0;
  errno = error;
  return -1;
}

extern "C" int sigwait(const sigset_t* set, int* signal) {
  if (current_task == nullptr) return LTSIM_NEXT(sigwait)(set, signal);
  *signal = current_task->world->signals().wait(*set, ltsim::VirtualClock::never);
  return 0;
}

extern "C" int sigtimedwait(const sigset_t* set, siginfo_t* information, const timespec* timeout) {
  if (current_task == nullptr) return LTSIM_NEXT(sigtimedwait)(set, information, timeout);
  World& world = *current_task->world;
  const ltsim::SimTime deadline = timeout == nullptr ? ltsim::VirtualClock::never
                                                     : world.now() + std::chrono::seconds{timeout->tv_sec} +
                                                           std::chrono::nanoseconds{timeout->tv_nsec};
  const int signal = world.signals().wait(*set, deadline);
  if (signal == 0) {
    errno = EAGAIN;
    return -1;
  }
  if (information != nullptr) {
    *information = {};
    information->si_signo = signal;
  }
  return signal;
}

extern "C" int sigwaitinfo(const sigset_t* set, siginfo_t* information) {
  if (current_task == nullptr) return LTSIM_NEXT(sigwaitinfo)(set, information);
  return sigtimedwait(set, information, nullptr);
}

extern "C" int kill(pid_t id, int signal) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(kill)(id, signal);
  World& world = *current_task->world;
  world.scheduler().point({.kind = ltsim::OperationKind::signal_send});
  if (signal < 0 || signal > Signals::signal_max) {
    errno = EINVAL;
    return -1;
  }
  for (std::size_t i = 0; i < world.processes_count(); ++i) {
    const auto process = static_cast<ltsim::ProcessId>(i);
    if (world.system_id(process) != id || !world.process(process).is_running()) continue;
    if (signal != 0) world.signals().send(process, signal);
    return 0;
  }
  if (id <= 0) world.unsupported(fmt::format("{} called kill for a group of processes", current_task->name));
  errno = ESRCH;
  return -1;
}

extern "C" sighandler_t signal(int number, sighandler_t handler) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(signal)(number, handler);
  const bool was_ignored =
      is_signal(number) && current_task->world->signals().is_ignored(current_task->process, number);
  if (!set_disposition("signal", number, handler)) return SIG_ERR;
  return was_ignored ? SIG_IGN : SIG_DFL;
}

extern "C" int sigaction(int number, const struct sigaction* action, struct sigaction* before) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(sigaction)(number, action, before);
  const bool was_ignored =
      is_signal(number) && current_task->world->signals().is_ignored(current_task->process, number);
  if (action != nullptr && !set_disposition("sigaction", number, action->sa_handler)) return -1;
  if (before != nullptr) {
    *before = {};
    before->sa_handler = was_ignored ? SIG_IGN : SIG_DFL;
  }
  return 0;
}
