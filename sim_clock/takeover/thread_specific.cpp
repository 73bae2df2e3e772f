// pthread_key_create(3) and what goes with it.
//
// A scenario may destroy objects of the code under test after the run, outside any task: a key that a task made is nobody's then.

#include <pthread.h>

#include <cerrno>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;
using ltsim::ThreadSpecific;

extern "C" int pthread_key_create(pthread_key_t* key, void (*destructor)(void*)) noexcept {
  if (current_task != nullptr) return current_task->world->thread_specific().create(key, destructor);
  const int result = LTSIM_NEXT(pthread_key_create)(key, destructor);
  if (result == 0) ThreadSpecific::was_made_by_libc(*key, destructor);
  return result;
}

extern "C" int pthread_key_delete(pthread_key_t key) noexcept {
  if (current_task != nullptr) return current_task->world->thread_specific().remove(key);
  if (ThreadSpecific::is_ours(key)) return 0;
  ThreadSpecific::was_removed_by_libc(key);
  return LTSIM_NEXT(pthread_key_delete)(key);
}

// libc declares that it leaves alone what `value` points to, so that compilers take handing it on for a use of what may be nothing
// yet. The assembler name keeps it apart from that declaration.
extern "C" int set_specific(pthread_key_t key, const void* value) noexcept asm("pthread_setspecific");
extern "C" int set_specific(pthread_key_t key, const void* value) noexcept {
  if (current_task != nullptr) return current_task->world->thread_specific().set(key, value);
  if (ThreadSpecific::is_ours(key)) return 0;
  using Function = int(pthread_key_t, const void*);
  static auto* const next = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "pthread_setspecific"));
  return next(key, value);
}

extern "C" void* pthread_getspecific(pthread_key_t key) noexcept {
  if (current_task != nullptr) return current_task->world->thread_specific().get(key);
  if (ThreadSpecific::is_ours(key)) return nullptr;
  return LTSIM_NEXT(pthread_getspecific)(key);
}
