// Signals that are waited for: sigwait(3) and its kind, masks, and kill(2) between simulated processes.
//
// No handler is ever called: programs that install one are refused (takeover/refused.cpp). A signal stays pending until somebody
// takes it, or it does what it does by default.
#pragma once

#include <signal.h>

#include <array>
#include <cstdint>

#include "sim_clock/clock/deadline.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;
class World;

class Signals {
 public:
  explicit Signals(World& world) noexcept : world_(world) {}
  void reset() noexcept;
  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;

  /// Linux numbers them from 1 to this; bit n - 1 of a set is signal n.
  static constexpr int signal_max = 64;
  using Set = std::uint64_t;

  /// pthread_sigmask(3) of the running task. @return 0 or EINVAL
  int change_mask(int how, const sigset_t* set, sigset_t* before) noexcept;
  /// A new thread has its creator's mask.
  void inherit_mask(TaskId child, TaskId creator) noexcept { masks_[child] = masks_[creator]; }

  /// Takes a pending signal of the set, the lowest one first; waits for it.
  /// @return  the signal; 0: the time is over
  int wait(const sigset_t& set, Deadline deadline) noexcept;
  /// Whether a thread of the process waits for the signal.
  [[nodiscard]] bool is_waited_for(ProcessId process, int signal) const noexcept;

  /// signal(2), as far as it can be without a handler.
  /// @param ignored  otherwise what it does by default
  void ignore(ProcessId process, int signal, bool ignored) noexcept;

  [[nodiscard]] bool is_ignored(ProcessId process, int signal) const noexcept {
    return (ignored_[process] >> (signal - 1) & 1) != 0;
  }

  /// kill(2) to one process, which lives. Ends it if that is what the signal does and nobody has asked for anything else; it may be
  /// the running one.
  /// @param signal  1 to signal_max
  void send(ProcessId process, int signal) noexcept;

  /// A new life of the process has none of it.
  void process_died(ProcessId process) noexcept;

 private:
  [[nodiscard]] static Set to_set(const sigset_t& signals) noexcept;
  [[nodiscard]] bool is_blocked_everywhere(ProcessId process, Set bit) const noexcept;

  World& world_;
  std::array<Set, tasks_max> masks_{};       // by task: what is blocked
  std::array<Set, tasks_max> waited_for_{};  // by task, while it waits
  std::array<Set, processes_max> pending_{};
  std::array<Set, processes_max> ignored_{};
};

}  // namespace ltsim
