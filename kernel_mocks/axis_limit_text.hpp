// An axis limit as the command line writes it: "X=-50:650", machine coordinates.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "kernel_mocks/motion.hpp"

namespace kernel_mocks {

struct AxisLimit {
  std::size_t axis = 0;
  AxisOptions::Travel travel{};
};

/// @return nothing when the axis is unknown, a number is none or not finite, or the first is above the second
[[nodiscard]] std::optional<AxisLimit> parse_axis_limit(std::string_view text);

}  // namespace kernel_mocks
