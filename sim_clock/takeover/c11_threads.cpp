// <threads.h> of C11: threads, mutexes, conditions, once and keys. glibc has them as others of its own objects, with other results, and
// calls itself directly; here they are the world's. thrd_sleep and thrd_yield: clocks.cpp.

#include <pthread.h>
#include <threads.h>

#include <cerrno>
#include <cstdint>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

namespace {

static_assert(sizeof(mtx_t) == sizeof(pthread_mutex_t) && sizeof(cnd_t) == sizeof(pthread_cond_t));
static_assert(sizeof(once_flag) == sizeof(pthread_once_t) && sizeof(tss_t) == sizeof(pthread_key_t));

pthread_mutex_t* as_posix(mtx_t* mutex) noexcept { return reinterpret_cast<pthread_mutex_t*>(mutex); }
pthread_cond_t* as_posix(cnd_t* condition) noexcept { return reinterpret_cast<pthread_cond_t*>(condition); }

/// @param error  0, or as POSIX numbers it
int as_c11(int error) noexcept {
  switch (error) {
    case 0:
      return thrd_success;
    case EBUSY:
      return thrd_busy;
    case ETIMEDOUT:
      return thrd_timedout;
    case ENOMEM:
      return thrd_nomem;
    default:
      return thrd_error;
  }
}

bool is_valid(const timespec& time) noexcept { return time.tv_nsec >= 0 && time.tv_nsec < 1'000'000'000; }

}  // namespace

// --- threads ---

extern "C" int thrd_create(thrd_t* thread, thrd_start_t start, void* argument) {
  if (current_task != nullptr) return as_c11(current_task->world->threads().create(thread, start, argument));
  if (ltsim::World::refuses_real("thrd_create")) return thrd_error;
  return LTSIM_NEXT(thrd_create)(thread, start, argument);
}

extern "C" int thrd_join(thrd_t thread, int* result) {
  if (current_task != nullptr || ltsim::Threads::is_simulated(thread)) {
    void* value = nullptr;
    const int error = pthread_join(thread, &value);
    if (error == 0 && result != nullptr) *result = static_cast<int>(reinterpret_cast<std::intptr_t>(value));
    return as_c11(error);
  }
  return LTSIM_NEXT(thrd_join)(thread, result);
}

extern "C" int thrd_detach(thrd_t thread) {
  if (current_task != nullptr || ltsim::Threads::is_simulated(thread)) return as_c11(pthread_detach(thread));
  return LTSIM_NEXT(thrd_detach)(thread);
}

extern "C" void thrd_exit(int result) {
  if (current_task != nullptr) pthread_exit(reinterpret_cast<void*>(static_cast<std::intptr_t>(result)));
  LTSIM_NEXT(thrd_exit)(result);
  __builtin_unreachable();
}

// --- mutexes ---

extern "C" int mtx_init(mtx_t* mutex, int type) {
  const int result = LTSIM_NEXT(mtx_init)(mutex, type);
  if (current_task != nullptr) current_task->world->segments().accept_change(mutex, sizeof *mutex);
  return result;
}

extern "C" int mtx_lock(mtx_t* mutex) {
  if (current_task != nullptr) return as_c11(current_task->world->mutexes().lock(as_posix(mutex)));
  if (ltsim::Mutexes::belongs_to_an_execution(as_posix(mutex))) return thrd_success;
  return LTSIM_NEXT(mtx_lock)(mutex);
}

extern "C" int mtx_trylock(mtx_t* mutex) {
  if (current_task != nullptr) return as_c11(current_task->world->mutexes().try_lock(as_posix(mutex)));
  if (ltsim::Mutexes::belongs_to_an_execution(as_posix(mutex))) return thrd_success;
  return LTSIM_NEXT(mtx_trylock)(mutex);
}

extern "C" int mtx_timedlock(mtx_t* mutex, const timespec* deadline) {
  if (current_task != nullptr) {
    if (!is_valid(*deadline)) return thrd_error;
    ltsim::World& world = *current_task->world;
    return as_c11(world.mutexes().timed_lock(as_posix(mutex), world.to_deadline(CLOCK_REALTIME, *deadline)));
  }
  return LTSIM_NEXT(mtx_timedlock)(mutex, deadline);
}

extern "C" int mtx_unlock(mtx_t* mutex) {
  if (current_task != nullptr) return as_c11(current_task->world->mutexes().unlock(as_posix(mutex)));
  if (ltsim::Mutexes::belongs_to_an_execution(as_posix(mutex))) return thrd_success;
  return LTSIM_NEXT(mtx_unlock)(mutex);
}

extern "C" void mtx_destroy(mtx_t* mutex) {
  if (current_task != nullptr) {
    static_cast<void>(current_task->world->mutexes().destroy(as_posix(mutex)));
  } else if (!ltsim::Mutexes::belongs_to_an_execution(as_posix(mutex))) {
    LTSIM_NEXT(mtx_destroy)(mutex);
  }
}

// --- conditions ---

extern "C" int cnd_init(cnd_t* condition) {
  const int result = LTSIM_NEXT(cnd_init)(condition);
  if (current_task != nullptr) current_task->world->segments().accept_change(condition, sizeof *condition);
  return result;
}

extern "C" int cnd_wait(cnd_t* condition, mtx_t* mutex) {
  if (current_task != nullptr)
    return as_c11(current_task->world->mutexes().wait(as_posix(condition), as_posix(mutex)));
  return LTSIM_NEXT(cnd_wait)(condition, mutex);
}

extern "C" int cnd_timedwait(cnd_t* condition, mtx_t* mutex, const timespec* deadline) {
  if (current_task != nullptr) {
    if (!is_valid(*deadline)) return thrd_error;
    ltsim::World& world = *current_task->world;
    return as_c11(world.mutexes().timed_wait(as_posix(condition), as_posix(mutex),
                                             world.to_deadline(CLOCK_REALTIME, *deadline)));
  }
  return LTSIM_NEXT(cnd_timedwait)(condition, mutex, deadline);
}

extern "C" int cnd_signal(cnd_t* condition) {
  if (current_task != nullptr) return as_c11(current_task->world->mutexes().signal(as_posix(condition)));
  return LTSIM_NEXT(cnd_signal)(condition);
}

extern "C" int cnd_broadcast(cnd_t* condition) {
  if (current_task != nullptr) return as_c11(current_task->world->mutexes().broadcast(as_posix(condition)));
  return LTSIM_NEXT(cnd_broadcast)(condition);
}

extern "C" void cnd_destroy(cnd_t* condition) {
  if (current_task != nullptr) return;  // no state of ours in it, and libc's would wait for real waiters
  LTSIM_NEXT(cnd_destroy)(condition);
}

// --- once, and keys ---

extern "C" void call_once(once_flag* flag, void (*initialise)()) {
  if (current_task != nullptr) {
    static_cast<void>(
        current_task->world->mutexes().once(reinterpret_cast<pthread_once_t*>(flag), initialise));
  } else {
    LTSIM_NEXT(call_once)(flag, initialise);
  }
}

extern "C" int tss_create(tss_t* key, tss_dtor_t destructor) {
  return as_c11(pthread_key_create(key, destructor));
}

extern "C" void tss_delete(tss_t key) { static_cast<void>(pthread_key_delete(key)); }

extern "C" int tss_set(tss_t key, void* value) { return as_c11(pthread_setspecific(key, value)); }

extern "C" void* tss_get(tss_t key) { return pthread_getspecific(key); }
