// Compiles an instruction-list source to the code of il_machine.hpp.
//
// All that can be known beforehand is refused here, with its place: wrong types (there is no implicit
// conversion), a CR that is not set on every way to where it is used, N where nothing can be negated, jumps out
// of or into parentheses, unknown or doubled names and labels, literals that do not fit, division by zero.
//
// The CR at a label is what all ways to it agree on. Since ways lead back, instructions are compiled again until
// no label changes; after passes_max times, every label counts as one without a CR.
#pragma once

#include <string_view>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/il_address_map.hpp"
#include "emulator_models/soft_plc/il_program.hpp"

namespace emulator_models::soft_plc {

/// Longest source, in bytes.
inline constexpr std::size_t source_bytes_max = 4'194'304;

/// @return the program, which does not point into the source; or the first mistake
[[nodiscard]] tl::expected<IlProgram, IlError> compile(std::string_view source);
/// For a PLC with an address map of its own: the process image is what the map says.
[[nodiscard]] tl::expected<IlProgram, IlError> compile(std::string_view source, const AddressMap& map);

}  // namespace emulator_models::soft_plc
