// pthread_rwlock_*(3). Initialisers and attributes are libc's own: they only fill memory, and where that lies in a segment the
// world is told.
//
// A scenario may destroy objects of the code under test after the run, outside any task: a lock that tasks used is nobody's then,
// and locking it does nothing.

#include <pthread.h>

#include <cerrno>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;
using ltsim::Rwlocks;

namespace {

bool is_valid(const timespec& time) noexcept { return time.tv_nsec >= 0 && time.tv_nsec < 1'000'000'000; }

bool is_valid(clockid_t clock) noexcept { return clock == CLOCK_REALTIME || clock == CLOCK_MONOTONIC; }

}  // namespace

extern "C" int pthread_rwlock_init(pthread_rwlock_t* lock, const pthread_rwlockattr_t* attributes) noexcept {
  const int result = LTSIM_NEXT(pthread_rwlock_init)(lock, attributes);
  if (current_task != nullptr) current_task->world->segments().accept_change(lock, sizeof *lock);
  return result;
}

extern "C" int pthread_rwlock_destroy(pthread_rwlock_t* lock) noexcept {
  if (current_task != nullptr) return current_task->world->rwlocks().destroy(lock);
  if (Rwlocks::belongs_to_an_execution(lock)) return 0;
  return LTSIM_NEXT(pthread_rwlock_destroy)(lock);
}

extern "C" int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  if (current_task != nullptr) return current_task->world->rwlocks().lock_to_read(lock);
  if (Rwlocks::belongs_to_an_execution(lock)) return 0;
  return LTSIM_NEXT(pthread_rwlock_rdlock)(lock);
}

extern "C" int pthread_rwlock_tryrdlock(pthread_rwlock_t* lock) noexcept {
  if (current_task != nullptr) return current_task->world->rwlocks().try_to_read(lock);
  if (Rwlocks::belongs_to_an_execution(lock)) return 0;
  return LTSIM_NEXT(pthread_rwlock_tryrdlock)(lock);
}

extern "C" int pthread_rwlock_timedrdlock(pthread_rwlock_t* lock, const timespec* deadline) noexcept {
  if (current_task != nullptr) {
    if (!is_valid(*deadline)) return EINVAL;
    ltsim::World& world = *current_task->world;
    return world.rwlocks().timed_lock_to_read(lock, world.to_deadline(CLOCK_REALTIME, *deadline));
  }
  return LTSIM_NEXT(pthread_rwlock_timedrdlock)(lock, deadline);
}

extern "C" int pthread_rwlock_clockrdlock(pthread_rwlock_t* lock, clockid_t clock,
                                          const timespec* deadline) noexcept {
  if (current_task != nullptr) {
    if (!is_valid(clock) || !is_valid(*deadline)) return EINVAL;
    ltsim::World& world = *current_task->world;
    return world.rwlocks().timed_lock_to_read(lock, world.to_deadline(clock, *deadline));
  }
  return LTSIM_NEXT(pthread_rwlock_clockrdlock)(lock, clock, deadline);
}

extern "C" int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  if (current_task != nullptr) return current_task->world->rwlocks().lock_to_write(lock);
  if (Rwlocks::belongs_to_an_execution(lock)) return 0;
  return LTSIM_NEXT(pthread_rwlock_wrlock)(lock);
}

extern "C" int pthread_rwlock_trywrlock(pthread_rwlock_t* lock) noexcept {
  if (current_task != nullptr) return current_task->world->rwlocks().try_to_write(lock);
  if (Rwlocks::belongs_to_an_execution(lock)) return 0;
  return LTSIM_NEXT(pthread_rwlock_trywrlock)(lock);
}

extern "C" int pthread_rwlock_timedwrlock(pthread_rwlock_t* lock, const timespec* deadline) noexcept {
  if (current_task != nullptr) {
    if (!is_valid(*deadline)) return EINVAL;
    ltsim::World& world = *current_task->world;
    return world.rwlocks().timed_lock_to_write(lock, world.to_deadline(CLOCK_REALTIME, *deadline));
  }
  return LTSIM_NEXT(pthread_rwlock_timedwrlock)(lock, deadline);
}

extern "C" int pthread_rwlock_clockwrlock(pthread_rwlock_t* lock, clockid_t clock,
                                          const timespec* deadline) noexcept {
  if (current_task != nullptr) {
    if (!is_valid(clock) || !is_valid(*deadline)) return EINVAL;
    ltsim::World& world = *current_task->world;
    return world.rwlocks().timed_lock_to_write(lock, world.to_deadline(clock, *deadline));
  }
  return LTSIM_NEXT(pthread_rwlock_clockwrlock)(lock, clock, deadline);
}

extern "C" int pthread_rwlock_unlock(pthread_rwlock_t* lock) noexcept {
  if (current_task != nullptr) return current_task->world->rwlocks().unlock(lock);
  if (Rwlocks::belongs_to_an_execution(lock)) return 0;
  return LTSIM_NEXT(pthread_rwlock_unlock)(lock);
}
