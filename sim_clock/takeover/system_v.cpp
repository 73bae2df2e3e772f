// System V shared memory and semaphores: shmget(2), semget(2) and their kind.

#include <sys/sem.h>
#include <sys/shm.h>

#include <cstdarg>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

extern "C" int shmget(key_t key, std::size_t bytes, int flags) noexcept {
  if (current_task != nullptr) return current_task->world->system_v_segments().get(key, bytes, flags);
  if (ltsim::World::refuses_real("shmget")) return -1;
  return LTSIM_NEXT(shmget)(key, bytes, flags);
}

extern "C" void* shmat(int id, const void* address, int flags) noexcept {
  if (current_task != nullptr) return current_task->world->system_v_segments().attach(id, address, flags);
  return LTSIM_NEXT(shmat)(id, address, flags);
}

extern "C" int shmdt(const void* address) noexcept {
  if (current_task != nullptr) return current_task->world->system_v_segments().detach(address);
  // A scenario destroys objects of the code under test after the run.
  return ltsim::Segments::contains(address) ? 0 : LTSIM_NEXT(shmdt)(address);
}

extern "C" int shmctl(int id, int command, shmid_ds* buffer) noexcept {
  if (current_task != nullptr) return current_task->world->system_v_segments().control(id, command, buffer);
  return LTSIM_NEXT(shmctl)(id, command, buffer);
}

extern "C" int semget(key_t key, int count, int flags) noexcept {
  if (current_task != nullptr) return current_task->world->system_v_semaphores().get(key, count, flags);
  if (ltsim::World::refuses_real("semget")) return -1;
  return LTSIM_NEXT(semget)(key, count, flags);
}

extern "C" int semop(int id, sembuf* operations, std::size_t count) noexcept {
  if (current_task != nullptr)
    return current_task->world->system_v_semaphores().operate(id, {operations, count}, nullptr);
  return LTSIM_NEXT(semop)(id, operations, count);
}

extern "C" int semtimedop(int id, sembuf* operations, std::size_t count, const timespec* within) noexcept {
  if (current_task != nullptr)
    return current_task->world->system_v_semaphores().operate(id, {operations, count}, within);
  return LTSIM_NEXT(semtimedop)(id, operations, count, within);
}

extern "C" int semctl(int id, int number, int command, ...) noexcept {
  // A word wide, as every member of the union is passed: which it is, or whether there is one, the command tells.
  va_list arguments;
  va_start(arguments, command);
  const auto argument = va_arg(arguments, ltsim::SystemVSemaphores::Argument);
  va_end(arguments);
  if (current_task != nullptr)
    return current_task->world->system_v_semaphores().control(id, number, command, argument);
  return LTSIM_NEXT(semctl)(id, number, command, argument);
}
