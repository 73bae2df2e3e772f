// Who plays which role on a segment: at most one kernel and one emulator.
//
// The published design has no such lock, and the wrappers do not use it; the programs take it, to know whether named objects
// that they find are in use or left over from a process that died. The hardened handoff has roles of its own; the programs
// take this lock with either handoff, so that those of different ones keep apart, too. The system frees the lock when its
// process ends, however it ends.
//
// The lock is an open-file-description lock (fcntl F_OFD_SETLK, Linux) on /tmp/ltsim-<segment>.<role>.lock.
// The folder does not follow TMPDIR, as the segment does not either: both sides must look at one place. The
// holder removes the file before it lets go; whoever locks a file checks that the name still leads to it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace protocol {

enum class Role : std::uint8_t { kernel, emulator };

[[nodiscard]] std::string_view to_string(Role role) noexcept;

enum class RoleLockError : std::uint8_t {
  held_by_other,  ///< another process plays this role on this segment
  cannot_open,    ///< the lock file cannot be made or opened: permissions, no space
};

[[nodiscard]] std::string_view to_string(RoleLockError error) noexcept;

class RoleLock {
 public:
  RoleLock(std::string_view segment_name, Role role);
  RoleLock(const RoleLock&) = delete;
  RoleLock& operator=(const RoleLock&) = delete;
  /// Releases.
  ~RoleLock();

  /// Takes the role, without waiting. A lock that is held already stays held.
  [[nodiscard]] tl::expected<void, RoleLockError> try_lock() noexcept;
  /// Removes the lock file and lets go. Releasing twice does nothing.
  void release() noexcept;
  [[nodiscard]] bool is_held() const noexcept;

  /// Whether somebody plays the role at this moment; another RoleLock of this process counts.
  [[nodiscard]] bool is_held_by_other() const noexcept;

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace protocol
