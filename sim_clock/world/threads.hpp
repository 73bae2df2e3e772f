// POSIX threads of the simulated world: each is a task of the process that created it.
#pragma once

#include <pthread.h>

namespace ltsim {

class World;
struct Task;

class Threads {
 public:
  explicit Threads(World& world) noexcept : world_(world) {}

  // The calls, for the running task; they return 0 or an error number as POSIX.1-2017 lists them.
  /// @param attributes  null: the defaults. Heeded are the detach state and the priority.
  int create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
             void* argument) noexcept;
  int join(pthread_t thread, void** result) noexcept;
  int detach(pthread_t thread) noexcept;

  /// @return null for a thread that no task of this execution is
  [[nodiscard]] Task* find(pthread_t thread) noexcept;

 private:
  World& world_;
};

}  // namespace ltsim
