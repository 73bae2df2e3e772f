// Durations in schedules and traces: exact, and as short as that allows: "20ms", "1500us", "100ns".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sim_clock/clock/virtual_clock.hpp"

namespace ltsim {

/// @param duration  >= 0
[[nodiscard]] std::string to_text(SimTime duration);
/// Reads what to_text() writes.
/// @return nothing if it is no such text or does not fit 64 bits
[[nodiscard]] std::optional<SimTime> parse_duration(std::string_view text) noexcept;

}  // namespace ltsim
