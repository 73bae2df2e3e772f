// The names of a program and where they lie: declarations laid out in memory.
//
// Retained variables come first, so that a warm start is one copy. Each value lies at a multiple of its size.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>

#include "emulator_models/soft_plc/il_address_map.hpp"
#include "emulator_models/soft_plc/il_blocks.hpp"
#include "emulator_models/soft_plc/il_program.hpp"

namespace emulator_models::soft_plc {

struct InstancePlace {
  BlockKind kind = BlockKind::ton;
  std::uint32_t offset = 0;
  BlockDevices devices;
};

using Symbol = std::variant<ValuePlace, InstancePlace>;
/// By name in capitals.
using SymbolTable = std::unordered_map<std::string, Symbol>;

/// Gives every variable and instance its place, and the program its initial variables. Devices and blocks that the PLC
/// has by itself become symbols when a statement names them.
/// Throws IlFailure: a doubled name, an unknown type, a value or an address that does not fit.
[[nodiscard]] SymbolTable lay_out(const SyntaxTree& tree, const AddressMap& map, IlProgram& program);

[[nodiscard]] ValuePlace place_in(const InstancePlace& instance, const BlockParameter& parameter) noexcept;

/// The place of an address, of the type `type` or else of the bit string of its size. Notes in the program how
/// many bytes of the image it needs. Throws IlFailure.
[[nodiscard]] ValuePlace place_of_address(std::string_view text, SourcePlace place, const AddressMap& map,
                                          IlProgram& program);

/// The value of a literal as the accumulator holds it. Throws IlFailure when it is none of the type.
[[nodiscard]] std::uint64_t literal_value(std::string_view text, ElementaryType type, SourcePlace place);

}  // namespace emulator_models::soft_plc
