// The machine behind the terminals of plc-emulator, by name, with what is broken in it.
//
// A failure is in force from a moment on that counts from the first scan; it never ends. Names are those of the plants'
// enumerations, with dashes: "flood-without-flow".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "emulator_models/fx_plc.hpp"

namespace emulator_models {

enum class PlantKind : std::uint8_t { machine_tool, propulsion, none };

[[nodiscard]] std::string_view to_string(PlantKind kind) noexcept;
/// @param name  "machine-tool", "propulsion", "none"
[[nodiscard]] std::optional<PlantKind> parse_plant(std::string_view name) noexcept;

/// The program that is written for this plant, in instruction list; without a plant, one that does nothing.
[[nodiscard]] std::string_view program_for(PlantKind kind) noexcept;

/// @param failures  "NAME", in force at once, or "NAME@SECONDS", a decimal number from 0 to 1 000 000
/// @return          what FxPlc calls in each scan, for one PLC; or what is wrong with a failure, and what there is
[[nodiscard]] tl::expected<FxPlc::Plant, std::string> make_plant(PlantKind kind,
                                                                 const std::vector<std::string>& failures);

}  // namespace emulator_models
