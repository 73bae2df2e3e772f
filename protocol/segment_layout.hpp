// Where the parts of the shared segment lie.
//
//   offset         size   field
//        0            4   state     of the request and of the response
//        4            4   request length in bytes
//        8           RQ   request bytes        RQ = capacity asked for, rounded up
//     8+RQ            4   response length in bytes
//    12+RQ           RS   response bytes       RS = capacity asked for, rounded up
//
// Integers are in host order. The published design says nothing of alignment; RQ and RS are rounded up to a
// multiple of 4, so that both lengths are aligned and can be accessed as one word.
#pragma once

#include <cstddef>
#include <cstdint>

#include "protocol/paper_options.hpp"

namespace protocol {

/// Length word and contents of one area.
struct AreaLayout {
  std::size_t length_offset = 0;
  std::size_t bytes_offset = 0;
  std::size_t capacity_bytes = 0;

  bool operator==(const AreaLayout&) const = default;
};

struct SegmentLayout {
  static constexpr std::size_t state_offset = 0;

  AreaLayout request;
  AreaLayout response;
  std::size_t size_bytes = 0;
};

/// @param request_bytes   capacities of the contents of both areas
/// @param response_bytes
[[nodiscard]] constexpr SegmentLayout segment_layout(std::size_t request_bytes,
                                                     std::size_t response_bytes) noexcept {
  constexpr std::size_t word_bytes = sizeof(std::uint32_t);
  const auto rounded_up = [](std::size_t bytes) {
    return (bytes + word_bytes - 1) / word_bytes * word_bytes;
  };
  const auto area_at = [](std::size_t offset, std::size_t capacity_bytes) {
    return AreaLayout{
        .length_offset = offset, .bytes_offset = offset + word_bytes, .capacity_bytes = capacity_bytes};
  };
  SegmentLayout layout;
  layout.request = area_at(SegmentLayout::state_offset + word_bytes, rounded_up(request_bytes));
  layout.response =
      area_at(layout.request.bytes_offset + layout.request.capacity_bytes, rounded_up(response_bytes));
  layout.size_bytes = layout.response.bytes_offset + layout.response.capacity_bytes;
  return layout;
}

[[nodiscard]] constexpr SegmentLayout segment_layout(const PaperOptions& options) noexcept {
  return segment_layout(options.request_bytes_max, options.response_bytes_max);
}

}  // namespace protocol
