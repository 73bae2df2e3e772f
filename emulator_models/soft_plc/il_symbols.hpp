// The names of a program and where they lie: declarations laid out in memory.
//
// Retained variables come first, so that a warm start is one copy. Each value lies at a multiple of its size.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>

#include "emulator_models/soft_plc/il_address.hpp"
#include "emulator_models/soft_plc/il_blocks.hpp"
#include "emulator_models/soft_plc/il_program.hpp"

namespace emulator_models::soft_plc {

/// A value that an instruction can name.
struct ValuePlace {
  ElementaryType type = ElementaryType::boolean;
  Area area = Area::variables;
  std::uint32_t offset = 0;
  std::uint8_t bit_index = 0;
  /// Why the program must not write it, "an input"; empty when it may.
  std::string_view read_only_as;
};

struct InstancePlace {
  BlockKind kind = BlockKind::ton;
  std::uint32_t offset = 0;
};

using Symbol = std::variant<ValuePlace, InstancePlace>;
/// By name in capitals.
using SymbolTable = std::unordered_map<std::string, Symbol>;

/// Gives every variable and instance its place, and the program its initial variables.
/// Throws IlFailure: a doubled name, an unknown type, a value or an address that does not fit.
[[nodiscard]] SymbolTable lay_out(std::span<const Declaration> declarations, IlProgram& program);

/// The place of an address, of the type `type` or else of the bit string of its size. Notes in the program how
/// many bytes of the image it needs. Throws IlFailure.
[[nodiscard]] ValuePlace place_of_address(std::string_view text, SourcePlace place, IlProgram& program);

/// The value of a literal as the accumulator holds it. Throws IlFailure when it is none of the type.
[[nodiscard]] std::uint64_t literal_value(std::string_view text, ElementaryType type, SourcePlace place);

}  // namespace emulator_models::soft_plc
