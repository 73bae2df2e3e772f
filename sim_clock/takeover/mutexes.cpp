// pthread_mutex_*(3), pthread_cond_*(3), pthread_once(3). Initialisers and attributes are libc's own: they
// only fill memory, and where that lies in a segment the world is told.
//
// A scenario may destroy objects of the code under test after the run, outside any task: a mutex that tasks
// used is nobody's then, and locking it does nothing.

#include <pthread.h>

#include <cerrno>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

namespace {

/// The clock that pthread_cond_init() put into the condition: glibc keeps it in bit 1 of the reference count
/// (nptl/pthreadP.h, __PTHREAD_COND_CLOCK_MONOTONIC_MASK).
clockid_t clock_of(const pthread_cond_t* condition) noexcept {
  constexpr unsigned monotonic_mask = 2;
  return (condition->__data.__wrefs & monotonic_mask) != 0 ? CLOCK_MONOTONIC : CLOCK_REALTIME;
}

bool is_valid(const timespec& time) noexcept { return time.tv_nsec >= 0 && time.tv_nsec < 1'000'000'000; }

}  // namespace

extern "C" int pthread_mutex_init(pthread_mutex_t* mutex, const pthread_mutexattr_t* attributes) noexcept {
  const int result = LTSIM_NEXT(pthread_mutex_init)(mutex, attributes);
  if (current_task != nullptr) current_task->world->segments().accept_change(mutex, sizeof *mutex);
  return result;
}

extern "C" int pthread_cond_init(pthread_cond_t* condition, const pthread_condattr_t* attributes) noexcept {
  const int result = LTSIM_NEXT(pthread_cond_init)(condition, attributes);
  if (current_task != nullptr) current_task->world->segments().accept_change(condition, sizeof *condition);
  return result;
}

extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  if (current_task != nullptr) return current_task->world->mutexes().lock(mutex);
  if (ltsim::Mutexes::belongs_to_an_execution(mutex)) return 0;
  return LTSIM_NEXT(pthread_mutex_lock)(mutex);
}

extern "C" int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  if (current_task != nullptr) return current_task->world->mutexes().try_lock(mutex);
  if (ltsim::Mutexes::belongs_to_an_execution(mutex)) return 0;
  return LTSIM_NEXT(pthread_mutex_trylock)(mutex);
}

extern "C" int pthread_mutex_timedlock(pthread_mutex_t* mutex, const timespec* deadline) noexcept {
  if (current_task != nullptr) {
    if (!is_valid(*deadline)) return EINVAL;
    ltsim::World& world = *current_task->world;
    return world.mutexes().timed_lock(mutex, world.to_deadline(CLOCK_REALTIME, *deadline));
  }
  return LTSIM_NEXT(pthread_mutex_timedlock)(mutex, deadline);
}

extern "C" int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock,
                                       const timespec* deadline) noexcept {
  if (current_task != nullptr) {
    if (!is_valid(*deadline)) return EINVAL;
    ltsim::World& world = *current_task->world;
    return world.mutexes().timed_lock(mutex, world.to_deadline(clock, *deadline));
  }
  return LTSIM_NEXT(pthread_mutex_clocklock)(mutex, clock, deadline);
}

extern "C" int pthread_mutex_unlock(pthread_mutex_t* mutex) noexcept {
  if (current_task != nullptr) return current_task->world->mutexes().unlock(mutex);
  if (ltsim::Mutexes::belongs_to_an_execution(mutex)) return 0;
  return LTSIM_NEXT(pthread_mutex_unlock)(mutex);
}

extern "C" int pthread_mutex_consistent(pthread_mutex_t* mutex) noexcept {
  if (current_task != nullptr) return current_task->world->mutexes().consistent(mutex);
  if (ltsim::Mutexes::belongs_to_an_execution(mutex)) return 0;
  return LTSIM_NEXT(pthread_mutex_consistent)(mutex);
}

extern "C" int pthread_mutex_destroy(pthread_mutex_t* mutex) noexcept {
  if (current_task != nullptr) return current_task->world->mutexes().destroy(mutex);
  if (ltsim::Mutexes::belongs_to_an_execution(mutex)) return 0;
  return LTSIM_NEXT(pthread_mutex_destroy)(mutex);
}

extern "C" int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  if (current_task != nullptr) return current_task->world->mutexes().wait(condition, mutex);
  return LTSIM_NEXT(pthread_cond_wait)(condition, mutex);
}

extern "C" int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                      const timespec* deadline) {
  if (current_task != nullptr) {
    if (!is_valid(*deadline)) return EINVAL;
    ltsim::World& world = *current_task->world;
    return world.mutexes().timed_wait(condition, mutex, world.to_deadline(clock_of(condition), *deadline));
  }
  return LTSIM_NEXT(pthread_cond_timedwait)(condition, mutex, deadline);
}

extern "C" int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                                      const timespec* deadline) {
  if (current_task != nullptr) {
    if (!is_valid(*deadline)) return EINVAL;
    ltsim::World& world = *current_task->world;
    return world.mutexes().timed_wait(condition, mutex, world.to_deadline(clock, *deadline));
  }
  return LTSIM_NEXT(pthread_cond_clockwait)(condition, mutex, clock, deadline);
}

extern "C" int pthread_cond_signal(pthread_cond_t* condition) noexcept {
  if (current_task != nullptr) return current_task->world->mutexes().signal(condition);
  return LTSIM_NEXT(pthread_cond_signal)(condition);
}

extern "C" int pthread_cond_broadcast(pthread_cond_t* condition) noexcept {
  if (current_task != nullptr) return current_task->world->mutexes().broadcast(condition);
  return LTSIM_NEXT(pthread_cond_broadcast)(condition);
}

extern "C" int pthread_cond_destroy(pthread_cond_t* condition) noexcept {
  if (current_task != nullptr) return 0;  // no state of ours in it, and libc's would wait for real waiters
  return LTSIM_NEXT(pthread_cond_destroy)(condition);
}

extern "C" int pthread_once(pthread_once_t* control, void (*initialise)()) {
  if (current_task != nullptr) return current_task->world->mutexes().once(control, initialise);
  return LTSIM_NEXT(pthread_once)(control, initialise);
}
