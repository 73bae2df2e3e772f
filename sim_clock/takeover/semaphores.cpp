// sem_*(3).

#include <fcntl.h>
#include <semaphore.h>

#include <cstdarg>
#include <string_view>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

extern "C" sem_t* sem_open(const char* name, int flags, ...) noexcept {
  mode_t mode = 0;
  unsigned value = 0;
  if ((flags & O_CREAT) != 0) {
    va_list arguments;
    va_start(arguments, flags);
    mode = va_arg(arguments, mode_t);
    value = va_arg(arguments, unsigned);
    va_end(arguments);
  }
  if (current_task != nullptr) {
    ltsim::Scheduler& scheduler = current_task->world->scheduler();
    scheduler.point({.kind = ltsim::OperationKind::sem_open,
                     .name = scheduler.name_for_strategy([name] { return std::string_view{name}; })});
    return current_task->world->semaphores().open(name, flags, value);
  }
  if (ltsim::World::refuses_real("sem_open")) return SEM_FAILED;
  return LTSIM_NEXT(sem_open)(name, flags, mode, value);
}

extern "C" int sem_close(sem_t* semaphore) noexcept {
  if (current_task != nullptr) return current_task->world->semaphores().close(semaphore);
  if (ltsim::Semaphores::is_named(semaphore))
    return 0;  // a scenario destroys objects of the code under test after the run
  return LTSIM_NEXT(sem_close)(semaphore);
}

extern "C" int sem_unlink(const char* name) noexcept {
  if (current_task != nullptr) return current_task->world->semaphores().unlink(name);
  return LTSIM_NEXT(sem_unlink)(name);
}

extern "C" int sem_init(sem_t* semaphore, int shared, unsigned value) noexcept {
  if (current_task != nullptr) return current_task->world->semaphores().init(semaphore, shared != 0, value);
  if (ltsim::World::refuses_real("sem_init")) return -1;
  return LTSIM_NEXT(sem_init)(semaphore, shared, value);
}

extern "C" int sem_destroy(sem_t* semaphore) noexcept {
  if (current_task != nullptr) return current_task->world->semaphores().destroy(semaphore);
  return LTSIM_NEXT(sem_destroy)(semaphore);
}

extern "C" int sem_wait(sem_t* semaphore) {
  if (current_task != nullptr) return current_task->world->semaphores().wait(semaphore);
  return LTSIM_NEXT(sem_wait)(semaphore);
}

extern "C" int sem_trywait(sem_t* semaphore) noexcept {
  if (current_task != nullptr) return current_task->world->semaphores().try_wait(semaphore);
  return LTSIM_NEXT(sem_trywait)(semaphore);
}

extern "C" int sem_timedwait(sem_t* semaphore, const timespec* deadline) {
  if (current_task != nullptr)
    return current_task->world->semaphores().timed_wait(semaphore, CLOCK_REALTIME, *deadline);
  return LTSIM_NEXT(sem_timedwait)(semaphore, deadline);
}

extern "C" int sem_clockwait(sem_t* semaphore, clockid_t clock, const timespec* deadline) {
  if (current_task != nullptr)
    return current_task->world->semaphores().timed_wait(semaphore, clock, *deadline);
  return LTSIM_NEXT(sem_clockwait)(semaphore, clock, deadline);
}

extern "C" int sem_post(sem_t* semaphore) noexcept {
  if (current_task != nullptr) return current_task->world->semaphores().post(semaphore);
  return LTSIM_NEXT(sem_post)(semaphore);
}

extern "C" int sem_getvalue(sem_t* semaphore, int* value) noexcept {
  if (current_task != nullptr) return current_task->world->semaphores().value(semaphore, *value);
  return LTSIM_NEXT(sem_getvalue)(semaphore, value);
}
