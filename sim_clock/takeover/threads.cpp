// pthread_create(3), joining, and the destructors of thread_local objects. pthread_self() needs no takeover:
// it reads the thread pointer, and each task has its own.
//
// A scenario may destroy objects of the code under test after the run, outside any task. Joining a thread
// that only existed in the world then does nothing.

#include <pthread.h>

#include <cerrno>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

namespace {

bool is_simulated(pthread_t thread) noexcept {
  return ltsim::TaskStorage::is_of_a_task(reinterpret_cast<const void*>(thread));
}

}  // namespace

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                              void* argument) noexcept {
  if (current_task != nullptr) {
    return current_task->world->threads().create(thread, attributes, start, argument);
  }
  if (ltsim::World::refuses_real("pthread_create")) return EAGAIN;
  return LTSIM_NEXT(pthread_create)(thread, attributes, start, argument);
}

extern "C" int pthread_join(pthread_t thread, void** result) {
  if (current_task != nullptr) return current_task->world->threads().join(thread, result);
  if (is_simulated(thread)) return 0;
  return LTSIM_NEXT(pthread_join)(thread, result);
}

extern "C" int pthread_detach(pthread_t thread) noexcept {
  if (current_task != nullptr) return current_task->world->threads().detach(thread);
  if (is_simulated(thread)) return 0;
  return LTSIM_NEXT(pthread_detach)(thread);
}

// The compilers' way to have a thread_local destroyed at the end of its thread; libc would run it at the end
// of the real one.
extern "C" int __cxa_thread_atexit_impl(void (*destroy)(void*), void* object, void* dso) noexcept {
  if (current_task != nullptr) {
    current_task->thread_local_destructors.push_back({destroy, object});
    return 0;
  }
  using Function = int(void (*)(void*), void*, void*);
  static auto* const next = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "__cxa_thread_atexit_impl"));
  return next(destroy, object, dso);
}
