// Locks for readers and writers of the simulated world: pthread_rwlock_t, and with it std::shared_mutex.
//
// As with mutexes, what a lock needs lies in the pthread_rwlock_t itself, so that one in a shared segment works across
// processes and a statically initialised one needs no call; who holds it is kept here. Whoever waits wakes when the lock
// may be had, and tries: who of them comes first, reader or writer, is the scheduler's choice.
//
// A reader goes in while others read, also if a writer waits: so does glibc with PTHREAD_RWLOCK_PREFER_READER_NP, its default,
// and with PTHREAD_RWLOCK_PREFER_WRITER_NP. With PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP it waits behind the writer, so who
// reads twice may wait for himself.
//
// What a writer has done comes before what all who lock later do; what a reader has done, before what writers do.
#pragma once

#include <pthread.h>

#include <cstdint>
#include <string>
#include <vector>

#include "sim_clock/clock/deadline.hpp"
#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;
class World;

class Rwlocks {
 public:
  explicit Rwlocks(World& world) noexcept : world_(world) {}
  void reset() noexcept {
    locks_.clear();
    readers_.clear();
  }

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;

  // The calls, for the running task; they return 0 or an error number as POSIX.1-2017 lists them.
  /// @return EDEADLK to who holds it for writing, as with glibc
  int lock_to_read(pthread_rwlock_t* lock) noexcept;
  int timed_lock_to_read(pthread_rwlock_t* lock, Deadline deadline) noexcept;
  int try_to_read(pthread_rwlock_t* lock) noexcept;
  int lock_to_write(pthread_rwlock_t* lock) noexcept;
  int timed_lock_to_write(pthread_rwlock_t* lock, Deadline deadline) noexcept;
  int try_to_write(pthread_rwlock_t* lock) noexcept;
  /// By who does not hold it: the execution ends as an assertion.
  int unlock(pthread_rwlock_t* lock) noexcept;
  /// @return EBUSY if it is held
  int destroy(pthread_rwlock_t* lock) noexcept;

  /// Whether a task of some execution has used this lock: outside any task it is nobody's then.
  [[nodiscard]] static bool belongs_to_an_execution(const pthread_rwlock_t* lock) noexcept;

  /// Who holds the lock of that name: the writer, or the readers in the order in which they came.
  [[nodiscard]] std::vector<TaskId> holders_of(ObjectId lock) const;
  /// The locks that are held by tasks that have ended, and by whom, in words; empty if there are none.
  [[nodiscard]] std::string held_at_end() const;

 private:
  struct State;
  struct Lock {
    ObjectId object;
    std::uint32_t writer_plus_one;
  };
  /// A lock that a task holds for reading.
  struct Reader {
    std::uint32_t lock;
    TaskId task;
    std::uint32_t count;
  };

  State& resolve(pthread_rwlock_t* lock) noexcept;
  [[nodiscard]] static WaitKey key_of(const State& state) noexcept;
  [[nodiscard]] static bool readers_wait(const State& state) noexcept;
  int acquire_to_read(pthread_rwlock_t* lock, OperationKind kind, Deadline deadline) noexcept;
  int acquire_to_write(pthread_rwlock_t* lock, OperationKind kind, Deadline deadline) noexcept;
  void take_to_read(State& state);
  void take_to_write(State& state) noexcept;
  /// @return whether the running task held it for reading
  bool leave_as_reader(State& state) noexcept;
  void state_changed(const State& state) noexcept;

  World& world_;
  std::vector<Lock> locks_;      // by State::number
  std::vector<Reader> readers_;  // in the order in which they came
};

}  // namespace ltsim
