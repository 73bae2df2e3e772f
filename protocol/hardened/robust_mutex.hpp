// A mutex in shared memory that the system frees when its owner dies.
//
// The owner is a thread: the mutex is free, too, when that thread ends. What a dead owner has left half done is the
// caller's matter; here every step that a lock guards may be made again.
#pragma once

#include <pthread.h>

#include <cerrno>
#include <chrono>

#include "protocol/check.hpp"
#include "protocol/deadline.hpp"

namespace protocol::hardened {

class RobustMutex {
 public:
  /// On memory that nobody else uses yet.
  [[nodiscard]] bool init() noexcept {
    pthread_mutexattr_t attributes;
    if (::pthread_mutexattr_init(&attributes) != 0) return false;
    const bool made = ::pthread_mutexattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED) == 0 &&
                      ::pthread_mutexattr_setrobust(&attributes, PTHREAD_MUTEX_ROBUST) == 0 &&
                      ::pthread_mutex_init(&mutex_, &attributes) == 0;
    ::pthread_mutexattr_destroy(&attributes);
    return made;
  }

  /// @return whether it was free, or its owner was dead
  [[nodiscard]] bool try_lock() noexcept { return is_mine(::pthread_mutex_trylock(&mutex_)); }

  /// @return whether it was free, or its owner dead, before the deadline
  [[nodiscard]] bool lock_until(std::chrono::steady_clock::time_point deadline) noexcept {
    const timespec until = on_monotonic_clock(deadline);
    return is_mine(::pthread_mutex_clocklock(&mutex_, CLOCK_MONOTONIC, &until));
  }

  /// By the thread that locked it.
  void unlock() noexcept { PLC_CHECK(::pthread_mutex_unlock(&mutex_) == 0); }

 private:
  bool is_mine(int result) noexcept {
    if (result == EOWNERDEAD) result = ::pthread_mutex_consistent(&mutex_);
    return result == 0;
  }

  pthread_mutex_t mutex_;
};

}  // namespace protocol::hardened
