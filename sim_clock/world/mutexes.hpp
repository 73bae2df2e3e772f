// Mutexes, conditions, once-initialisation and futex words of the simulated world.
//
// The state of a mutex lies in the pthread_mutex_t itself, so that one in a shared segment works across
// processes and a statically initialised one (all zeros) needs no call. The kind (normal, recursive,
// error-checking) stays where pthread_mutex_init put it. Conditions hold no state: their waiters are known by
// the address. Who holds a mutex is kept here as well: for messages, and at the end, when its memory may be
// gone.
//
// PTHREAD_PRIO_INHERIT has its effect on Cpu::one_fifo. A robust mutex whose owner ends or is killed goes to the
// next who locks it, with EOWNERDEAD.
//
// Not here: PTHREAD_PRIO_PROTECT (accepted, without effect).
#pragma once

#include <pthread.h>

#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "sim_clock/clock/deadline.hpp"
#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/scheduler.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;

class Mutexes {
 public:
  explicit Mutexes(World& world) noexcept : world_(world) {}
  void reset() noexcept;

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;
  // The calls, for the running task; they return 0 or an error number as POSIX.1-2017 lists them.
  int lock(pthread_mutex_t* mutex) noexcept;
  int try_lock(pthread_mutex_t* mutex) noexcept;
  int timed_lock(pthread_mutex_t* mutex, Deadline deadline) noexcept;
  int unlock(pthread_mutex_t* mutex) noexcept;
  int consistent(pthread_mutex_t* mutex) noexcept;
  int destroy(pthread_mutex_t* mutex) noexcept;

  int wait(pthread_cond_t* condition, pthread_mutex_t* mutex) noexcept;
  int timed_wait(pthread_cond_t* condition, pthread_mutex_t* mutex, Deadline deadline) noexcept;
  int signal(pthread_cond_t* condition) noexcept;
  int broadcast(pthread_cond_t* condition) noexcept;

  /// An exception of `initialise` passes through; then the next one may try.
  int once(pthread_once_t* control, void (*initialise)());

  /// The task has ended or was killed: what it holds and is robust goes to the next.
  void owner_died(TaskId owner) noexcept {
    if (!robust_held_.empty()) [[unlikely]]
      release_robust_of(owner);
  }

  /// Whether a task of some execution has used this mutex: outside any task it is nobody's then.
  [[nodiscard]] static bool belongs_to_an_execution(const pthread_mutex_t* mutex) noexcept;

  /// Who holds the mutex of that name; null: nobody.
  [[nodiscard]] const Task* owner_of(ObjectId mutex) const noexcept;
  /// The mutexes that are held, and by whom, in words; empty if there are none.
  [[nodiscard]] std::string held_at_end() const;
  /// Whether who waits for the key waits for a mutex.
  [[nodiscard]] static bool is_mutex_key(WaitKey key) noexcept { return (key & mutex_key_mark) != 0; }

  /// FUTEX_WAIT: blocks while the word still has the value `expected`.
  /// @return 0; or -1 with errno EAGAIN or ETIMEDOUT
  int futex_wait(const std::uint32_t* word, std::uint32_t expected, Deadline deadline, bool shared) noexcept;
  /// FUTEX_WAKE. @return tasks woken
  int futex_wake(const std::uint32_t* word, std::size_t count_max, bool shared) noexcept;

 private:
  static constexpr WaitKey mutex_key_mark = std::uint64_t{1} << 61U;
  struct State;
  struct Lock {
    ObjectId object;
    std::uint32_t owner_plus_one;
  };

  State& resolve(pthread_mutex_t* mutex) noexcept;
  int acquire(State& state, const void* address, OperationKind kind, Deadline deadline) noexcept;
  /// Blocks while somebody else owns the mutex, and lends its priority if the mutex says so.
  Scheduler::Wake wait_for_owner(const State& state, const void* address, Deadline deadline) noexcept;
  int wait_until(pthread_cond_t* condition, pthread_mutex_t* mutex, OperationKind kind,
                 Deadline deadline) noexcept;
  /// @return 0; or EPERM where the mutex's kind checks its owner. Otherwise the execution ends as an
  /// assertion.
  int check_owner(const State& state) noexcept;
  void release(State& state, const void* address) noexcept;
  /// The running task becomes the owner of a mutex that is free.
  /// @return 0, or EOWNERDEAD if the last owner died
  int take(State& state, const void* address) noexcept;
  /// Tells that the state was changed by us, in case that it lies in a segment.
  void state_changed(const State& state) noexcept;
  void release_robust_of(TaskId owner) noexcept;
  void set_owner(State& state, std::uint32_t owner_plus_one) noexcept;
  [[nodiscard]] static WaitKey mutex_key(const void* address, std::int32_t kind) noexcept;

  struct RobustHeld {
    State* state;
    const void* address;
    TaskId owner;
  };

  World& world_;
  std::vector<RobustHeld> robust_held_;  // in the order in which they were locked
  std::vector<Lock> locks_;              // by State::number
};

}  // namespace ltsim
