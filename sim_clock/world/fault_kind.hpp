// Faults that a scenario can grant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace ltsim {

/// The names in to_string() are those of schedule files: a name once published stays.
enum class FaultKind : std::uint8_t {
  crash,          ///< a process is killed where it stands, as by kill -9
  lost_post,      ///< sem_post says that it has posted, and has not
  doubled_post,   ///< sem_post posts twice
  spurious_wake,  ///< a wait on a condition or a futex returns although nobody signalled
  interrupt,      ///< a call that can be interrupted fails with EINTR
  clock_step,     ///< the wall clock is set forward or back
  bit_flip,       ///< one bit of a segment changes
  foreign_write,  ///< somebody who has no business there writes into a segment
  call_failure,   ///< shm_open, ftruncate or mmap fails
  process_stall,  ///< a process gets no processor for a while, with all its tasks
};

inline constexpr std::size_t fault_kinds_count = static_cast<std::size_t>(FaultKind::process_stall) + 1;

[[nodiscard]] std::string_view to_string(FaultKind kind) noexcept;

}  // namespace ltsim
