// A named semaphore that wakes the other side and says nothing: whoever returns from a wait, for whatever reason, looks
// at the state word.
//
// POSIX calls rather than Boost.Interprocess, whose time-outs are on the wall clock: here they are on the monotonic one
// (sem_clockwait, glibc 2.30), so that setting the clock moves no time-out. The system makes a named semaphore whole
// before its name is visible.
#pragma once

#include <semaphore.h>

#include <chrono>
#include <string>

namespace protocol::hardened {

class Doorbell {
 public:
  Doorbell() = default;
  Doorbell(const Doorbell&) = delete;
  Doorbell& operator=(const Doorbell&) = delete;
  ~Doorbell() { close(); }

  /// Makes the semaphore with count 0, or opens the one that is there, whatever its count.
  /// @param name  without '/'
  /// @return whether the system let it
  [[nodiscard]] bool open(const std::string& name) noexcept;
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept { return semaphore_ != nullptr; }
  /// @return whether there was one of that name
  static bool remove(const std::string& name) noexcept;

  // All of these need an open one.

  /// Async-signal-safe. A bell that cannot take one more ring (SEM_VALUE_MAX) is rung already.
  void ring() const noexcept;
  /// Returns after a ring, or a signal.
  void wait() const noexcept;
  /// Returns after a ring, a signal, or at the deadline; never before it without one of these.
  void wait_until(std::chrono::steady_clock::time_point deadline) const noexcept;
  /// Takes one ring back.
  /// @return whether there was one
  bool try_take() const noexcept;
  /// Takes every ring back that is there.
  void empty() const noexcept;

 private:
  sem_t* semaphore_ = nullptr;
};

}  // namespace protocol::hardened
