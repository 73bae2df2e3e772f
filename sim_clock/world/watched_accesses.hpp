// Which plain accesses of instrumented code the world is told of: those to segments, or, while somebody needs it, more.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim_clock/world/segments.hpp"

namespace ltsim {

namespace watched_accesses {
// From Segments::range_begin on. It is all that decides whether an announced access returns at once.
inline constinit std::size_t read_bytes = Segments::range_bytes;
inline constinit std::size_t written_bytes = Segments::range_bytes;
}  // namespace watched_accesses

/// In a whole program, for good.
inline void watch_all_accesses() noexcept {
  watched_accesses::read_bytes = watched_accesses::written_bytes = ~std::size_t{0};
}

/// @param all  false: only what watch_all_accesses() has asked for, or those to segments
inline void watch_all_writes(bool all) noexcept {
  watched_accesses::written_bytes = all ? ~std::size_t{0} : watched_accesses::read_bytes;
}

/// While it lives the simulator writes what is its own: what std::string and its kind do may be the copy of them that lies in
/// instrumented code, and is no write of the code under test.
class UnwatchedWrites {
 public:
  UnwatchedWrites() noexcept : watched_(watched_accesses::written_bytes) {
    watched_accesses::written_bytes = Segments::range_bytes;
  }
  ~UnwatchedWrites() { watched_accesses::written_bytes = watched_; }
  UnwatchedWrites(const UnwatchedWrites&) = delete;
  UnwatchedWrites& operator=(const UnwatchedWrites&) = delete;

 private:
  std::size_t watched_;
};

[[nodiscard]] inline bool is_watched_read(const volatile void* address) noexcept {
  return reinterpret_cast<std::uintptr_t>(address) - Segments::range_begin < watched_accesses::read_bytes;
}
[[nodiscard]] inline bool is_watched_write(const volatile void* address) noexcept {
  return reinterpret_cast<std::uintptr_t>(address) - Segments::range_begin < watched_accesses::written_bytes;
}

}  // namespace ltsim
