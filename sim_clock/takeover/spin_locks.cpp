// pthread_spin_*(3). The initialiser is libc's own.

#include <pthread.h>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

extern "C" int pthread_spin_init(pthread_spinlock_t* lock, int shared) noexcept {
  const int result = LTSIM_NEXT(pthread_spin_init)(lock, shared);
  if (current_task != nullptr) current_task->world->spin_locks().was_made(lock);
  return result;
}

extern "C" int pthread_spin_destroy(pthread_spinlock_t* lock) noexcept {
  if (current_task != nullptr) return current_task->world->spin_locks().destroy(lock);
  return LTSIM_NEXT(pthread_spin_destroy)(lock);
}

extern "C" int pthread_spin_lock(pthread_spinlock_t* lock) noexcept {
  if (current_task != nullptr) return current_task->world->spin_locks().lock(lock);
  return LTSIM_NEXT(pthread_spin_lock)(lock);
}

extern "C" int pthread_spin_trylock(pthread_spinlock_t* lock) noexcept {
  if (current_task != nullptr) return current_task->world->spin_locks().try_lock(lock);
  return LTSIM_NEXT(pthread_spin_trylock)(lock);
}

extern "C" int pthread_spin_unlock(pthread_spinlock_t* lock) noexcept {
  if (current_task != nullptr) return current_task->world->spin_locks().unlock(lock);
  return LTSIM_NEXT(pthread_spin_unlock)(lock);
}
