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
  int create(pthread_t* thread, bool detached, void* (*start)(void*), void* argument) noexcept;
  int join(pthread_t thread, void** result) noexcept;
  int detach(pthread_t thread) noexcept;

 private:
  [[nodiscard]] Task* find(pthread_t thread) noexcept;

  World& world_;
};

}  // namespace ltsim
