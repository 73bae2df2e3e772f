// Spin locks of the simulated world: pthread_spinlock_t.
//
// Its four bytes stay as glibc's pthread_spin_init() leaves them; who holds it is kept here, by the place in memory, so that one
// in a segment works across processes. Who spins waits as for a mutex; on Cpu::one_fifo it polls, and keeps the processor from
// who has the lower priority, be it the owner.
#pragma once

#include <pthread.h>

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;
class World;

class SpinLocks {
 public:
  explicit SpinLocks(World& world) noexcept : world_(world) {}
  void reset() noexcept {
    if (locks_.empty()) return;
    locks_.clear();
    by_place_.clear();
  }

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;

  // The calls, for the running task; they return 0 or an error number as POSIX.1-2017 lists them. What pthread_spin_init()
  // has not made ends the execution as a crash, and so does, as an assertion, an unlock by who does not hold it.
  /// pthread_spin_init() has made it, perhaps where another one was.
  void was_made(pthread_spinlock_t* lock) noexcept;
  int lock(pthread_spinlock_t* lock) noexcept;
  int try_lock(pthread_spinlock_t* lock) noexcept;
  int unlock(pthread_spinlock_t* lock) noexcept;
  /// @return EBUSY if it is held
  int destroy(pthread_spinlock_t* lock) noexcept;

  /// Who holds the lock of that name; null: nobody.
  [[nodiscard]] const Task* owner_of(ObjectId lock) const noexcept;
  /// The locks that are held by tasks that have ended, and by whom, in words; empty if there are none.
  [[nodiscard]] std::string held_at_end() const;

 private:
  struct Lock {
    ObjectId object;
    std::uint32_t owner_plus_one;
  };

  Lock& resolve(pthread_spinlock_t* lock, OperationKind kind) noexcept;
  void take(Lock& lock) noexcept;

  World& world_;
  std::vector<Lock> locks_;
  std::unordered_map<std::uint64_t, std::size_t> by_place_;  // Segments::canonical(); index into locks_
};

}  // namespace ltsim
