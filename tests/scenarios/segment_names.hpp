// Names for the fields of the shared segment, for schedules and traces.
#pragma once

#include <string_view>

#include "protocol/segment_layout.hpp"
#include "sim_clock/world/world.hpp"

namespace scenarios {

inline void name_regions(ltsim::World& world, std::string_view segment,
                         const protocol::SegmentLayout& layout) {
  const auto name = [&](std::size_t offset, std::size_t bytes, std::string_view region) {
    world.name_region(segment, static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(bytes), region);
  };
  name(protocol::SegmentLayout::state_offset, 4, "segment.state");
  name(layout.request.length_offset, 4, "segment.request-length");
  name(layout.request.bytes_offset, layout.request.capacity_bytes, "segment.request");
  name(layout.response.length_offset, 4, "segment.response-length");
  name(layout.response.bytes_offset, layout.response.capacity_bytes, "segment.response");
}

inline void name_regions(ltsim::World& world, std::string_view segment,
                         const protocol::PaperOptions& options) {
  name_regions(world, segment, protocol::segment_layout(options));
}

}  // namespace scenarios
