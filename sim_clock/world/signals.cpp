#include "sim_clock/world/signals.hpp"

#include <bit>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "sim_clock/world/state_hash.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

constexpr Signals::Set bit_of(int signal) noexcept { return Signals::Set{1} << (signal - 1); }

/// signal(7): whose default is to do nothing.
constexpr Signals::Set harmless = bit_of(SIGCHLD) | bit_of(SIGURG) | bit_of(SIGWINCH) | bit_of(SIGCONT);

WaitKey key_of(ProcessId process) noexcept { return WaitKey{1} << 62U | process; }

}  // namespace

void Signals::reset() noexcept {
  masks_.fill(0);
  waited_for_.fill(0);
  pending_.fill(0);
  ignored_.fill(0);
}

void Signals::add_state(StateHash& hash) const noexcept {
  for (std::size_t i = 0; i < world_.scheduler().tasks_count(); ++i) {
    hash.add(masks_[i]);
    hash.add(waited_for_[i]);
  }
  for (const Set set : pending_) hash.add(set);
  for (const Set set : ignored_) hash.add(set);
}

Signals::Set Signals::to_set(const sigset_t& signals) noexcept {
  Set set = 0;
  std::memcpy(&set, &signals, sizeof set);  // Linux: the first word of glibc's sigset_t
  return set;
}

int Signals::change_mask(int how, const sigset_t* set, sigset_t* before) noexcept {
  Set& mask = masks_[current_task->id];
  const Set old = mask;
  if (set != nullptr) {
    switch (how) {
      case SIG_BLOCK:
        mask |= to_set(*set);
        break;
      case SIG_UNBLOCK:
        mask &= ~to_set(*set);
        break;
      case SIG_SETMASK:
        mask = to_set(*set);
        break;
      default:
        return EINVAL;
    }
    mask &= ~(bit_of(SIGKILL) | bit_of(SIGSTOP));
  }
  if (before != nullptr) {
    sigemptyset(before);
    std::memcpy(before, &old, sizeof old);
  }
  if (Set freed = old & ~mask & pending_[current_task->process]; freed != 0) {
    const int signal = std::countr_zero(freed) + 1;
    pending_[current_task->process] &= ~bit_of(signal);
    send(current_task->process, signal);
  }
  return 0;
}

int Signals::wait(const sigset_t& signals, Deadline deadline) noexcept {
  const Task& self = *current_task;
  world_.scheduler().point({.kind = OperationKind::signal_wait});
  const Set set = to_set(signals);
  Set& pending = pending_[self.process];
  waited_for_[self.id] = set;
  while ((pending & set) == 0) {
    if (world_.now() >= world_.sim_time_of(deadline)) break;
    world_.scheduler().block(key_of(self.process), deadline);
  }
  waited_for_[self.id] = 0;
  if ((pending & set) == 0) return 0;
  const int signal = std::countr_zero(pending & set) + 1;
  pending &= ~bit_of(signal);
  world_.checks().acquire(self.id, SyncKey::signals(self.process));
  return signal;
}

bool Signals::is_waited_for(ProcessId process, int signal) const noexcept {
  const Scheduler& scheduler = world_.scheduler();
  for (std::size_t i = 0; i < scheduler.tasks_count(); ++i) {
    const Task& task = scheduler.task(static_cast<TaskId>(i));
    if (task.process == process && task.state == Task::State::blocked &&
        (waited_for_[i] & bit_of(signal)) != 0)
      return true;
  }
  return false;
}

void Signals::ignore(ProcessId process, int signal, bool ignored) noexcept {
  if (ignored) {
    ignored_[process] |= bit_of(signal);
    pending_[process] &= ~bit_of(signal);
  } else {
    ignored_[process] &= ~bit_of(signal);
  }
}

bool Signals::is_blocked_everywhere(ProcessId process, Set bit) const noexcept {
  const Scheduler& scheduler = world_.scheduler();
  for (std::size_t i = 0; i < scheduler.tasks_count(); ++i) {
    const Task& task = scheduler.task(static_cast<TaskId>(i));
    const bool has_ended = task.state == Task::State::finished || task.state == Task::State::killed;
    if (task.process == process && !has_ended && (masks_[i] & bit) == 0) return false;
  }
  return true;
}

void Signals::send(ProcessId process, int signal) noexcept {
  const Set bit = bit_of(signal);
  if (current_task != nullptr) world_.checks().release(current_task->id, SyncKey::signals(process));
  if (is_waited_for(process, signal) || is_blocked_everywhere(process, bit)) {
    pending_[process] |= bit;
    world_.scheduler().wake(key_of(process), tasks_max);
    return;
  }
  if (((ignored_[process] | harmless) & bit) != 0) return;
  if (current_task != nullptr && current_task->process == process) {
    const GhostScope ghost;
    world_.scheduler().fail(OutcomeKind::crash,
                            fmt::format("{} was ended by signal {}, {}", world_.process_name(process), signal,
                                        strsignal(signal)));
  }
  world_.end_process(process);
}

void Signals::process_died(ProcessId process) noexcept {
  pending_[process] = 0;
  ignored_[process] = 0;
}

}  // namespace ltsim
