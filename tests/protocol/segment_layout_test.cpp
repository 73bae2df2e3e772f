// Offsets as the published design gives them: state, then request, then response, each area with its length
// in front.

#include <gtest/gtest.h>

#include "protocol/segment_layout.hpp"

namespace protocol {
namespace {

PaperOptions capacities(std::uint32_t request_bytes_max, std::uint32_t response_bytes_max) {
  PaperOptions options;
  options.request_bytes_max = request_bytes_max;
  options.response_bytes_max = response_bytes_max;
  return options;
}

TEST(SegmentLayout, begins_with_four_bytes_of_state) {
  EXPECT_EQ(SegmentLayout::state_offset, 0u);
  EXPECT_EQ(segment_layout({}).request.length_offset, 4u);
}

TEST(SegmentLayout, puts_the_request_area_before_the_response_area) {
  const SegmentLayout layout = segment_layout(capacities(256, 64));
  EXPECT_EQ(layout.request, (AreaLayout{.length_offset = 4, .bytes_offset = 8, .capacity_bytes = 256}));
  EXPECT_EQ(layout.response, (AreaLayout{.length_offset = 264, .bytes_offset = 268, .capacity_bytes = 64}));
  EXPECT_EQ(layout.size_bytes, 332u);
}

TEST(SegmentLayout, aligns_the_response_length_after_a_request_area_of_odd_size) {
  const SegmentLayout layout = segment_layout(capacities(5, 1));
  EXPECT_EQ(layout.request.capacity_bytes, 8u);
  EXPECT_EQ(layout.response.length_offset, 16u);
  EXPECT_EQ(layout.response.capacity_bytes, 4u);
}

TEST(SegmentLayout, may_have_areas_without_room) {
  EXPECT_EQ(segment_layout(capacities(0, 0)).size_bytes, 12u);
}

}  // namespace
}  // namespace protocol
