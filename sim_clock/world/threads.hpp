// POSIX threads of the simulated world: each is a task of the process that created it.
#pragma once

#include <pthread.h>

namespace ltsim {

class World;
struct Task;

class Threads {
 public:
  explicit Threads(World& world) noexcept : world_(world) {}
  void reset() noexcept { created_count_ = 0; }

  // The calls, for the running task; they return 0 or an error number as POSIX.1-2017 lists them.
  int create(pthread_t* thread, void* (*start)(void*), void* argument) noexcept;
  int join(pthread_t thread, void** result) noexcept;
  int detach(pthread_t thread) noexcept;

 private:
  [[nodiscard]] Task* find(pthread_t thread) noexcept;

  World& world_;
  unsigned created_count_ = 0;
};

}  // namespace ltsim
