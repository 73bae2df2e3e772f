// A semaphore that wakes the other side and says nothing: whoever returns from a wait, for whatever reason, looks at the
// state word.
//
// POSIX calls rather than Boost.Interprocess, whose time-outs are on the wall clock: here they are on the monotonic one
// (sem_clockwait, glibc 2.30), so that setting the clock moves no time-out.
//
// In a shared memory object of its own, not a named semaphore of the system: glibc's sem_open() makes one in a file of a
// random name first, and who is killed before it has the right one leaves a file that nobody can tell from another's.
//
//   offset  size  field
//        0    32  the semaphore
//       32     4  1: it is made; 0: whoever opens it makes it, also after one who was killed while he did
#pragma once

#include <semaphore.h>

#include <chrono>
#include <string>

#include "protocol/hardened/named_memory.hpp"

namespace protocol::hardened {

class Doorbell {
 public:
  Doorbell() = default;
  Doorbell(const Doorbell&) = delete;
  Doorbell& operator=(const Doorbell&) = delete;

  /// Makes the semaphore with count 0, or opens the one that is there, whatever its count. One opener at a time.
  /// @param name  without '/'
  /// @return whether the system let it
  [[nodiscard]] bool open(const std::string& name) noexcept;
  void close() noexcept { memory_.close(); }
  [[nodiscard]] bool is_open() const noexcept { return memory_.is_open(); }
  /// @return whether there was one of that name
  static bool remove(const std::string& name) noexcept { return NamedMemory::remove(name); }

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
  /// Takes every ring back that is there; of more than there can be between two sides that keep to the protocol, some stay. They
  /// mean nothing, and who empties must come to an end.
  void empty() const noexcept;

 private:
  struct Layout;

  [[nodiscard]] Layout& layout() const noexcept;
  [[nodiscard]] sem_t* semaphore() const noexcept;

  NamedMemory memory_;
};

}  // namespace protocol::hardened
