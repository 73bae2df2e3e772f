// pthread_barrier_*(3). The initialiser and attributes are libc's own.
//
// A scenario may destroy objects of the code under test after the run, outside any task: a barrier that tasks used is nobody's then.

#include <pthread.h>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

extern "C" int pthread_barrier_init(pthread_barrier_t* barrier, const pthread_barrierattr_t* attributes,
                                    unsigned count) noexcept {
  const int result = LTSIM_NEXT(pthread_barrier_init)(barrier, attributes, count);
  if (result == 0 && current_task != nullptr) current_task->world->barriers().was_made(barrier);
  return result;
}

extern "C" int pthread_barrier_destroy(pthread_barrier_t* barrier) noexcept {
  if (current_task != nullptr) return current_task->world->barriers().destroy(barrier);
  if (ltsim::Barriers::belongs_to_an_execution(barrier)) return 0;
  return LTSIM_NEXT(pthread_barrier_destroy)(barrier);
}

extern "C" int pthread_barrier_wait(pthread_barrier_t* barrier) noexcept {
  if (current_task != nullptr) return current_task->world->barriers().wait(barrier);
  return LTSIM_NEXT(pthread_barrier_wait)(barrier);
}
