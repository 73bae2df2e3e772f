// System V semaphores of the simulated world: sets of counts, semop(2) and its kind.
//
// As on Linux the counts of a new set are 0 until somebody sets them, which another process may come before; the operations of one call
// happen together or not at all; and what a process has done with SEM_UNDO is taken back when it ends or dies. Who waits is not served in the
// order of coming: each change wakes all, and the first that can go on does.
#pragma once

#include <sys/sem.h>
#include <sys/types.h>

#include <cstddef>
#include <ctime>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sim_clock/clock/deadline.hpp"
#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;
class World;

class SystemVSemaphores {
 public:
  static constexpr int value_max = 32767;             // SEMVMX, linux/sem.h
  static constexpr int semaphores_max = 32000;        // of a set: SEMMSL
  static constexpr std::size_t operations_max = 500;  // of one call: SEMOPM

  /// What semctl(2) takes as its last argument; which member counts, the command tells.
  union Argument {
    int value;
    semid_ds* status;
    unsigned short* values;
  };

  explicit SystemVSemaphores(World& world) noexcept : world_(world) {}
  void reset() noexcept { sets_.clear(); }

  // The calls, for the running task; errors as Linux's manual pages list them, in errno.
  int get(key_t key, int count, int flags);
  /// @param within  null: for ever
  int operate(int id, std::span<const sembuf> operations, const timespec* within);
  int control(int id, int number, int command, Argument argument);

  /// What the process has done with SEM_UNDO is taken back.
  void process_died(ProcessId process);

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;

 private:
  struct Semaphore {
    ObjectId object = 0;
    int value = 0;
    ProcessId last_process = 0;
  };
  /// What is to be added to a semaphore when a process ends.
  struct Undo {
    ProcessId process;
    unsigned short number;
    int adjustment;
  };
  struct Set {
    key_t key = IPC_PRIVATE;
    ObjectId object = 0;
    std::vector<Semaphore> semaphores;
    std::vector<Undo> undos;
    std::vector<std::pair<TaskId, sembuf>>
        waiting;  ///< whose call waits, for the operation that it cannot make
    bool removed = false;
  };
  /// What has become of the operations of a call.
  struct Attempt {
    int error = 0;                         ///< they cannot be made, now or ever; 0
    std::optional<sembuf> waits_for = {};  ///< they cannot be made yet, for this one
  };

  /// @return null, with EINVAL in errno, if there is none
  [[nodiscard]] Set* find(int id);
  /// All of them, or none.
  [[nodiscard]] Attempt attempt(Set& set, std::span<const sembuf> operations);
  /// The running task has added `change` to the count, or waited for zero: what that comes after, and what after it.
  void order(const Semaphore& semaphore, int change);
  [[nodiscard]] Deadline deadline_in(const timespec* within) const noexcept;
  void add_undo(Set& set, ProcessId process, unsigned short number, int adjustment);
  /// Whoever waits looks again.
  void changed(const Set& set);
  [[nodiscard]] int count_waiting(const Set& set, int number, bool for_zero) const noexcept;

  World& world_;
  std::vector<Set> sets_;  // by identifier
};

}  // namespace ltsim
