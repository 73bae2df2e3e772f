// A std::mutex whose holder has, for as long as it holds up a real-time thread, that thread's priority.
//
// A driver (priority 1) that is interrupted within a critical section by a cycle that hangs would otherwise keep the
// watchdog (priority 40) waiting for as long as the cycle hangs: nobody would stop it (I20).
//
// It stays a std::mutex, made anew through its native handle before anybody has seen it, and not a class of its own: so a
// std::condition_variable waits with it. std::condition_variable_any has a mutex inside that inherits nothing.
// Every mutex that a real-time thread waits for is one of these, also where the usual holder has an ordinary priority.
#pragma once

#include <mutex>

#include <pthread.h>

namespace emulator_models::soft_plc {

class InheritingMutex : public std::mutex {
 public:
  /// On a host without inheritance it is an ordinary mutex.
  InheritingMutex() noexcept {
#ifndef LTSIM_MUTANT_PLAIN_MUTEX
    pthread_mutexattr_t attributes;
    if (pthread_mutexattr_init(&attributes) != 0) return;
    if (pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT) == 0)
      static_cast<void>(pthread_mutex_init(native_handle(), &attributes));
    pthread_mutexattr_destroy(&attributes);
#endif
  }
  InheritingMutex(const InheritingMutex&) = delete;
  InheritingMutex& operator=(const InheritingMutex&) = delete;
  ~InheritingMutex() = default;
};

}  // namespace emulator_models::soft_plc
