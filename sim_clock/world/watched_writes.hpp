// Which plain writes of instrumented code the world is told of: those to segments, or, while somebody needs it, all there are.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim_clock/world/segments.hpp"

namespace ltsim {

namespace watched_writes {
/// From Segments::range_begin on. It is all that decides whether an announced write returns at once.
inline constinit std::size_t bytes = Segments::range_bytes;
}  // namespace watched_writes

/// @param all  false: those to segments
inline void watch_all_writes(bool all) noexcept {
  watched_writes::bytes = all ? ~std::size_t{0} : Segments::range_bytes;
}

[[nodiscard]] inline bool is_watched_write(const volatile void* address) noexcept {
  return reinterpret_cast<std::uintptr_t>(address) - Segments::range_begin < watched_writes::bytes;
}

}  // namespace ltsim
