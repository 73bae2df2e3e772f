// POSIX threads of the simulated world: each is a task of the process that created it.
#pragma once

#include <pthread.h>

#include "sim_clock/clock/deadline.hpp"
#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/task.hpp"
#include "sim_clock/world/task_storage.hpp"

namespace ltsim {

class Threads {
 public:
  explicit Threads(World& world) noexcept : world_(world) {}

  // The calls, for the running task; they return 0 or an error number as POSIX.1-2017 lists them.
  /// @param attributes  null: the defaults. Heeded are the detach state and the priority.
  int create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
             void* argument) noexcept;
  /// thrd_create(3): with all defaults, and a start routine whose number pthread_join() gives as a pointer.
  int create(pthread_t* thread, int (*start)(void*), void* argument) noexcept;
  int join(pthread_t thread, void** result) noexcept;
  /// @return EBUSY while the thread has not ended
  int try_join(pthread_t thread, void** result) noexcept;
  /// @return ETIMEDOUT if it has not ended by then
  int timed_join(pthread_t thread, void** result, Deadline deadline) noexcept;
  int detach(pthread_t thread) noexcept;

  /// Whether it is a task, of whichever execution.
  [[nodiscard]] static bool is_simulated(pthread_t thread) noexcept {
    return TaskStorage::is_of_a_task(reinterpret_cast<const void*>(thread));
  }

  /// @return null for a thread that no task of this execution is
  [[nodiscard]] Task* find(pthread_t thread) noexcept;

 private:
  /// @return the new task, which has no body yet
  Task& create_task(pthread_t* thread, const pthread_attr_t* attributes) noexcept;
  int join_before(pthread_t thread, void** result, OperationKind kind, Deadline deadline) noexcept;
  /// @return 0, or why the running task cannot join it
  [[nodiscard]] static int check_joinable(const Task* task) noexcept;
  void has_ended(Task& task, void** result) noexcept;

  World& world_;
};

}  // namespace ltsim
