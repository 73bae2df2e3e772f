// What the targets against a hostile peer have in common: a segment that somebody else has made, and rewrites.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/paper_options.hpp"
#include "protocol/segment_layout.hpp"
#include "sim_clock/world/world.hpp"
#include "tests/scenarios/segment_names.hpp"

namespace fuzz {

inline constexpr const char* segment = "handoff";

/// Areas of 8 bytes: a length that does not fit is one that a byte holds.
inline protocol::PaperOptions small_areas() {
  protocol::PaperOptions options;
  options.request_bytes_max = 8;
  options.response_bytes_max = 8;
  return options;
}

/// The answer to one question as so many that can be answered by yes or no.
struct Switches {
  std::size_t bits;
  [[nodiscard]] bool operator[](unsigned index) const noexcept { return (bits >> index & 1U) != 0; }
};

/// The segment is there, exactly as large as it has to be, and before each access one byte of it may become 0, 255 or one more
/// than it was.
inline void leave_to_hostile_peer(ltsim::World& world, const protocol::SegmentLayout& layout,
                                  unsigned tokens) {
  constexpr std::array<std::byte, 64> zeros{};
  constexpr unsigned without_limit = 1'000'000;
  constexpr std::uint64_t points_max = 20'000;
  world.set_points_max(points_max);
  world.leave_segment(segment, std::span{zeros}.first(layout.size_bytes));
  world.leave_semaphore(segment, tokens);
  world.grant_in(ltsim::FaultKind::foreign_write, segment, 0, static_cast<std::uint32_t>(layout.size_bytes),
                 without_limit);
}

}  // namespace fuzz
