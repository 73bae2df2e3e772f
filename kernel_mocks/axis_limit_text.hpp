// An axis limit as the command line writes it: "X=-50:650", machine coordinates. All axes stand at zero when a program
// starts, so zero has to be within.
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

/// @return nothing when the axis is unknown, a number is none or not finite, or zero is not between them
[[nodiscard]] std::optional<AxisLimit> parse_axis_limit(std::string_view text);

}  // namespace kernel_mocks
