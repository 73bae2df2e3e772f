// Who plays which role on a segment: one master and one slave, each held by a lock outside of the segment that the
// system frees when its holder dies.
//
// The locks are robust mutexes in a shared memory object of its own, SEGMENT.roles:
//
//   offset  size  field
//        0     4  published   which set of locks counts, from 1; 0: none yet
//        4     4  claimed     sets that somebody has begun to make
//        8     8  segment     identity of the segment that is attached to; 0: of none yet
//       16   16*n sets of three locks: making, master, slave
//
// A set is made without a name, by one process alone, and then published by one swap; the first one published counts,
// for good. So nobody sees a lock that is not whole, nobody waits for one that is being made, and a process that is
// killed while it makes a set has used up one of sets_max.
//
// `making` guards the making, opening and removing of all named objects. Only the holder of both roles removes them.
// Whoever has taken a role checks that the name still leads to this object: from then on it does so until he gives the
// role back, as nobody else can come to hold both.
//
// Invariants
//   I28  at most one live holder of each role.
//   No lock is waited for without a bound.
// The thread that takes a role must be the one that gives it back, and live as long as it is held.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <tl/expected.hpp>

#include "protocol/hardened/named_memory.hpp"
#include "protocol/hardened/robust_mutex.hpp"
#include "protocol/shared_memory_error.hpp"

namespace protocol::hardened {

enum class Side : std::uint8_t { master, slave };

class Roles {
 public:
  explicit Roles(const std::string& segment_name) : name_(object_name(segment_name)) {}
  Roles(const Roles&) = delete;
  Roles& operator=(const Roles&) = delete;
  ~Roles() { give_back(); }

  /// Takes the role, and the lock for making the named objects.
  /// @param deadline  for that lock
  /// @return cannot_open; role_taken: somebody plays it; not_made_in_time
  [[nodiscard]] tl::expected<void, SharedMemoryError> take(
      Side side, std::chrono::steady_clock::time_point deadline) noexcept;
  /// The named objects are there and open.
  void made() noexcept;
  /// Takes the other role as well, if nobody plays it.
  /// @return whether it is held now
  [[nodiscard]] bool try_take_other() noexcept;
  void give_back_other() noexcept;
  /// Gives back what is held.
  void give_back() noexcept;

  /// Which segment is attached to. Under the lock for making.
  [[nodiscard]] MemoryIdentity segment() const noexcept;
  void set_segment(MemoryIdentity segment) noexcept;

  /// Whether there is such an object: it is made before all others of a segment.
  [[nodiscard]] static bool exist(const std::string& segment_name) noexcept {
    return NamedMemory::identity_of(object_name(segment_name)).has_value();
  }
  /// Removes this object; the holder of both roles, under the lock for making, after all others.
  void remove() noexcept { NamedMemory::remove(name_); }

 private:
  struct Locks {
    RobustMutex making, master, slave;
  };
  struct Layout;

  [[nodiscard]] static std::string object_name(const std::string& segment_name) {
    return segment_name + ".roles";
  }
  [[nodiscard]] bool open() noexcept;
  [[nodiscard]] Locks* find_or_make_locks() noexcept;
  [[nodiscard]] RobustMutex& lock_of(Side side) const noexcept {
    return side == Side::master ? locks_->master : locks_->slave;
  }
  [[nodiscard]] Layout& layout() const noexcept;

  std::string name_;
  NamedMemory memory_;
  Locks* locks_ = nullptr;
  Side side_ = Side::master;
  bool holds_role_ = false;
  bool holds_other_ = false;
  bool holds_making_ = false;
};

}  // namespace protocol::hardened
