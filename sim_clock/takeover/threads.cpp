// pthread_create(3), joining, and the destructors of thread_local objects. pthread_self() needs no takeover:
// it reads the thread pointer, and each task has its own.

#include <pthread.h>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                              void* argument) noexcept {
  if (current_task != nullptr) return current_task->world->threads().create(thread, start, argument);
  return LTSIM_NEXT(pthread_create)(thread, attributes, start, argument);
}

extern "C" int pthread_join(pthread_t thread, void** result) {
  if (current_task != nullptr) return current_task->world->threads().join(thread, result);
  return LTSIM_NEXT(pthread_join)(thread, result);
}

extern "C" int pthread_detach(pthread_t thread) noexcept {
  if (current_task != nullptr) return current_task->world->threads().detach(thread);
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
