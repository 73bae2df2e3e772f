#include "sim_clock/world/operation.hpp"

namespace ltsim {

std::string_view to_string(OperationKind kind) noexcept {
  switch (kind) {
    case OperationKind::read:
      return "read";
    case OperationKind::write:
      return "write";
    case OperationKind::atomic_load:
      return "atomic_load";
    case OperationKind::atomic_store:
      return "atomic_store";
    case OperationKind::atomic_exchange:
      return "atomic_exchange";
    case OperationKind::atomic_update:
      return "atomic_update";
    case OperationKind::sem_open:
      return "sem_open";
    case OperationKind::sem_close:
      return "sem_close";
    case OperationKind::sem_unlink:
      return "sem_unlink";
    case OperationKind::sem_init:
      return "sem_init";
    case OperationKind::sem_destroy:
      return "sem_destroy";
    case OperationKind::sem_wait:
      return "sem_wait";
    case OperationKind::sem_trywait:
      return "sem_trywait";
    case OperationKind::sem_timedwait:
      return "sem_timedwait";
    case OperationKind::sem_post:
      return "sem_post";
    case OperationKind::sem_getvalue:
      return "sem_getvalue";
    case OperationKind::mutex_lock:
      return "mutex_lock";
    case OperationKind::mutex_trylock:
      return "mutex_trylock";
    case OperationKind::mutex_timedlock:
      return "mutex_timedlock";
    case OperationKind::mutex_unlock:
      return "mutex_unlock";
    case OperationKind::cond_wait:
      return "cond_wait";
    case OperationKind::cond_timedwait:
      return "cond_timedwait";
    case OperationKind::cond_signal:
      return "cond_signal";
    case OperationKind::cond_broadcast:
      return "cond_broadcast";
    case OperationKind::futex_wait:
      return "futex_wait";
    case OperationKind::futex_wake:
      return "futex_wake";
    case OperationKind::once:
      return "once";
    case OperationKind::thread_create:
      return "thread_create";
    case OperationKind::thread_join:
      return "thread_join";
    case OperationKind::thread_start:
      return "thread_start";
    case OperationKind::thread_end:
      return "thread_end";
    case OperationKind::shm_open:
      return "shm_open";
    case OperationKind::shm_status:
      return "shm_status";
    case OperationKind::shm_unlink:
      return "shm_unlink";
    case OperationKind::shm_resize:
      return "shm_resize";
    case OperationKind::shm_map:
      return "shm_map";
    case OperationKind::shm_unmap:
      return "shm_unmap";
    case OperationKind::clock_read:
      return "clock_read";
    case OperationKind::sleep:
      return "sleep";
    case OperationKind::yield:
      return "yield";
    case OperationKind::atomic_fence:
      return "atomic_fence";
    case OperationKind::rwlock_rdlock:
      return "rwlock_rdlock";
    case OperationKind::rwlock_tryrdlock:
      return "rwlock_tryrdlock";
    case OperationKind::rwlock_timedrdlock:
      return "rwlock_timedrdlock";
    case OperationKind::rwlock_wrlock:
      return "rwlock_wrlock";
    case OperationKind::rwlock_trywrlock:
      return "rwlock_trywrlock";
    case OperationKind::rwlock_timedwrlock:
      return "rwlock_timedwrlock";
    case OperationKind::rwlock_unlock:
      return "rwlock_unlock";
    case OperationKind::spin_lock:
      return "spin_lock";
    case OperationKind::spin_trylock:
      return "spin_trylock";
    case OperationKind::spin_unlock:
      return "spin_unlock";
    case OperationKind::barrier_wait:
      return "barrier_wait";
    case OperationKind::static_init:
      return "static_init";
    case OperationKind::thread_tryjoin:
      return "thread_tryjoin";
    case OperationKind::thread_timedjoin:
      return "thread_timedjoin";
    case OperationKind::signal_wait:
      return "signal_wait";
    case OperationKind::signal_send:
      return "signal_send";
    case OperationKind::semop:
      return "semop";
    case OperationKind::semop_nowait:
      return "semop_nowait";
    case OperationKind::semctl:
      return "semctl";
    case OperationKind::semctl_get:
      return "semctl_get";
  }
  return "?";
}

bool changes_what_others_see(OperationKind kind) noexcept {
  switch (kind) {
    case OperationKind::write:
    case OperationKind::atomic_store:
    case OperationKind::sem_unlink:
    case OperationKind::sem_init:
    case OperationKind::sem_post:
    case OperationKind::cond_signal:
    case OperationKind::cond_broadcast:
    case OperationKind::futex_wake:
    case OperationKind::thread_create:
    case OperationKind::shm_unlink:
    case OperationKind::shm_resize:
    case OperationKind::signal_send:
    case OperationKind::semop:
    case OperationKind::semctl:
      return true;
    default:
      return false;
  }
}

bool depend(const Operation& one, const Operation& other) noexcept {
  if (is_memory_access(one.kind) != is_memory_access(other.kind)) return false;
  if (one.object != other.object) return false;
  if (!is_memory_access(one.kind)) return one.object != 0 || (one.offset != 0 && one.offset == other.offset);
  if (!changes_memory(one.kind) && !changes_memory(other.kind)) return false;
  return one.offset < other.offset + other.bytes && other.offset < one.offset + one.bytes;
}

}  // namespace ltsim
