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

bool is_valid(const timespec& time) noexcept { return time.tv_nsec >= 0 && time.tv_nsec < 1'000'000'000; }

int join_before(pthread_t thread, void** result, clockid_t clock, const timespec* deadline) noexcept {
  ltsim::World& world = *current_task->world;
  if (deadline == nullptr) return world.threads().join(thread, result);
  if (!is_valid(*deadline)) return EINVAL;
  return world.threads().timed_join(thread, result, world.to_deadline(clock, *deadline));
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
  if (ltsim::Threads::is_simulated(thread)) return 0;
  return LTSIM_NEXT(pthread_join)(thread, result);
}

extern "C" int pthread_tryjoin_np(pthread_t thread, void** result) noexcept {
  if (current_task != nullptr) return current_task->world->threads().try_join(thread, result);
  if (ltsim::Threads::is_simulated(thread)) return 0;
  return LTSIM_NEXT(pthread_tryjoin_np)(thread, result);
}

extern "C" int pthread_timedjoin_np(pthread_t thread, void** result, const timespec* deadline) {
  if (current_task != nullptr) return join_before(thread, result, CLOCK_REALTIME, deadline);
  if (ltsim::Threads::is_simulated(thread)) return 0;
  return LTSIM_NEXT(pthread_timedjoin_np)(thread, result, deadline);
}

extern "C" int pthread_clockjoin_np(pthread_t thread, void** result, clockid_t clock,
                                    const timespec* deadline) {
  if (current_task != nullptr) {
    if (clock != CLOCK_REALTIME && clock != CLOCK_MONOTONIC) return EINVAL;
    return join_before(thread, result, clock, deadline);
  }
  if (ltsim::Threads::is_simulated(thread)) return 0;
  return LTSIM_NEXT(pthread_clockjoin_np)(thread, result, clock, deadline);
}

extern "C" int pthread_detach(pthread_t thread) noexcept {
  if (current_task != nullptr) return current_task->world->threads().detach(thread);
  if (ltsim::Threads::is_simulated(thread)) return 0;
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
