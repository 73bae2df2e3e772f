// The G codes that this control has, and their modal groups.
//
// Motion is noted and not carried out yet, so a G code is here when nothing but its reading is needed. What
// would need more than that (canned cycles, tables of the control, probing, threads) is refused.
// Groups: EIA RS-274-D and LinuxCNC's interpreter, which agree on all of these.
#pragma once

#include <cstdint>
#include <optional>

#include "kernel_mocks/decimal.hpp"

namespace kernel_mocks {

enum class GGroup : std::uint8_t {
  non_modal,
  motion,
  plane,
  distance,
  arc_distance,
  feed_mode,
  units,
  cutter_compensation,
  tool_length,
  coordinate_system,
  path_control,
  spindle_mode,
  diameter,
};
inline constexpr unsigned g_group_count = 13;

/// A G code in tenths: G1 is 10, G59.3 is 593.
using GTenths = std::uint16_t;

/// @return nothing when the number is negative, above 99.9 or has more than one decimal place
[[nodiscard]] std::optional<GTenths> g_tenths(Decimal value) noexcept;
/// @return nothing when this control does not have the code
[[nodiscard]] std::optional<GGroup> g_group(GTenths code) noexcept;
/// G73, G74, G76 and G81 to G89, decimal places included.
[[nodiscard]] bool is_canned_cycle(GTenths code) noexcept;

}  // namespace kernel_mocks
