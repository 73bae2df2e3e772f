#include "sim_clock/explore/dependence.hpp"

#include <algorithm>

namespace ltsim {
namespace {

/// What a kind of operation acts on, besides the object that it names.
enum class Domain : std::uint8_t {
  nothing,     // its own task, or what another task can only wait for
  memory,      // bytes of a segment, or at an address
  object,      // a semaphore, a lock or a barrier
  condition,   // conditions, and the mutex that it names
  futex,       // words that are waited on
  once,        // what is initialised once
  names,       // the names of semaphores and segments, and the sizes of the latter
  everything,  // the order matters to all
  ends,        // whether a task has ended, which each of its steps may be the last before
};

Domain domain_of(OperationKind kind) noexcept {
  switch (kind) {
    case OperationKind::read:
    case OperationKind::write:
    case OperationKind::atomic_load:
    case OperationKind::atomic_store:
    case OperationKind::atomic_exchange:
    case OperationKind::atomic_update:
      return Domain::memory;
    case OperationKind::sem_wait:
    case OperationKind::sem_trywait:
    case OperationKind::sem_timedwait:
    case OperationKind::sem_post:
    case OperationKind::sem_getvalue:
    case OperationKind::sem_destroy:
    case OperationKind::mutex_lock:
    case OperationKind::mutex_trylock:
    case OperationKind::mutex_timedlock:
    case OperationKind::mutex_unlock:
    case OperationKind::rwlock_rdlock:
    case OperationKind::rwlock_tryrdlock:
    case OperationKind::rwlock_timedrdlock:
    case OperationKind::rwlock_wrlock:
    case OperationKind::rwlock_trywrlock:
    case OperationKind::rwlock_timedwrlock:
    case OperationKind::rwlock_unlock:
    case OperationKind::spin_lock:
    case OperationKind::spin_trylock:
    case OperationKind::spin_unlock:
    case OperationKind::barrier_wait:
    case OperationKind::semop:
    case OperationKind::semop_nowait:
    case OperationKind::semctl:
    case OperationKind::semctl_get:
      return Domain::object;
    case OperationKind::cond_wait:
    case OperationKind::cond_timedwait:
    case OperationKind::cond_signal:
    case OperationKind::cond_broadcast:
      return Domain::condition;
    case OperationKind::futex_wait:
    case OperationKind::futex_wake:
      return Domain::futex;
    case OperationKind::once:
    case OperationKind::static_init:
      return Domain::once;
    case OperationKind::thread_tryjoin:
    case OperationKind::thread_timedjoin:
      return Domain::ends;
    case OperationKind::sem_open:
    case OperationKind::sem_unlink:
    case OperationKind::shm_open:
    case OperationKind::shm_unlink:
    case OperationKind::shm_status:
    case OperationKind::shm_resize:
    case OperationKind::shm_map:
      return Domain::names;
    case OperationKind::sem_close:
    case OperationKind::shm_unmap:
    case OperationKind::thread_create:
    case OperationKind::thread_join:
    case OperationKind::thread_start:
    case OperationKind::thread_end:
    case OperationKind::clock_read:
    case OperationKind::sleep:
    case OperationKind::yield:
    case OperationKind::atomic_fence:
      return Domain::nothing;
    case OperationKind::signal_wait:
    case OperationKind::signal_send:
    case OperationKind::sem_init:  // makes an object that has no name yet
      return Domain::everything;
  }
  return Domain::everything;
}

bool only_looks(const StepEffect& step) noexcept {
  switch (step.operation.kind) {
    case OperationKind::read:
    case OperationKind::atomic_load:
    case OperationKind::sem_getvalue:
    case OperationKind::semctl_get:
    case OperationKind::shm_status:
    case OperationKind::shm_map:
      return true;
    default:
      return step.looks;
  }
}

}  // namespace

bool order_matters(const StepEffect& one, const StepEffect& other, bool memory_is_weak) noexcept {
  if (one.is_barrier || other.is_barrier) return true;
  const Operation& a = one.operation;
  const Operation& b = other.operation;
  if (memory_is_weak && a.is_seq_cst && b.is_seq_cst) return true;
  const Domain of_a = domain_of(a.kind);
  const Domain of_b = domain_of(b.kind);
  if (of_a == Domain::ends || of_b == Domain::ends) return true;
  if (of_a == Domain::nothing || of_b == Domain::nothing) return false;
  if (of_a == Domain::everything || of_b == Domain::everything) return true;
  if (only_looks(one) && only_looks(other)) return false;
  if (of_a == Domain::memory && of_b == Domain::memory)
    return a.object == b.object && a.offset < b.offset + b.bytes && b.offset < a.offset + a.bytes;
  if (of_a == Domain::names && of_b == Domain::names) return a.name == b.name || a.name == 0 || b.name == 0;
  const bool has_condition = of_a == Domain::condition || of_b == Domain::condition;
  const bool has_object = of_a == Domain::object || of_b == Domain::object;
  // To wait for a condition is to unlock a mutex, and then to lock it.
  if (has_condition && (has_object || of_a == of_b)) return of_a == of_b || a.object == b.object;
  if (of_a == Domain::object && of_b == Domain::object) return a.object == b.object;
  // A futex word is memory; which, is not known here.
  if (of_a == Domain::futex || of_b == Domain::futex)
    return of_a == of_b || of_a == Domain::memory || of_b == Domain::memory;
  return of_a == Domain::once && of_b == Domain::once;
}

}  // namespace ltsim
