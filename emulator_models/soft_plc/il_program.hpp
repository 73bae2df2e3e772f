// A compiled instruction-list program: what the machine runs, and all it needs to run it.
//
// Each instruction has 8 bytes and names at most one operand: an area, a byte in it, and for a BOOL a bit of
// that byte, so that a variable, a constant and a bit of an image are read by the same instruction. Compilation
// has checked every offset, target and type; the machine checks only what is known at run time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "emulator_models/soft_plc/il_error.hpp"
#include "emulator_models/soft_plc/il_syntax.hpp"
#include "emulator_models/soft_plc/il_types.hpp"

namespace emulator_models::soft_plc {

enum class Area : std::uint8_t { variables, constants, inputs, outputs, memory };
inline constexpr std::size_t areas_count = 5;

/// How deep deferred operations nest.
inline constexpr std::size_t nesting_max = 16;
inline constexpr std::size_t code_length_max = 65'536;
/// Bytes of all variables and instances of a program.
inline constexpr std::size_t variables_bytes_max = 1'048'576;

/// acc is the accumulator. "bit": a BOOL operand. `_not`: the operand is negated. `_deferred`: the left side is
/// the slot `offset`, the right one the accumulator.
enum class Opcode : std::uint8_t {
  load_bit,
  load_bit_not,
  store_bit,
  store_bit_not,
  set_bit,    ///< the bit is set if acc
  reset_bit,  ///< the bit is cleared if acc
  and_bit,
  and_bit_not,
  or_bit,
  or_bit_not,
  xor_bit,
  xor_bit_not,
  not_bit,
  and_bit_deferred,
  and_bit_not_deferred,
  or_bit_deferred,
  or_bit_not_deferred,
  xor_bit_deferred,
  xor_bit_not_deferred,
  defer,    ///< slot := acc
  restore,  ///< acc := slot
  jump,     ///< to the instruction `offset`
  jump_if,
  jump_if_not,
  end_scan,
  load,
  load_not,
  store,
  store_not,
  complement,            ///< acc := NOT acc, of a bit string
  operate,               ///< acc := acc OP operand; `detail` is the Operation
  operate_not,           ///< for bit strings
  operate_deferred,      ///< acc := slot OP acc
  operate_not_deferred,  ///< acc := slot OP NOT acc, for bit strings
  absolute,
  convert,     ///< from the ElementaryType `detail` to `type`
  shift,       ///< `detail` is kind + 4 * type of acc, `type` that of the count
  call_block,  ///< the instance at `offset`, of the BlockKind `detail`
};

struct Instruction {
  Opcode opcode = Opcode::end_scan;
  Area area = Area::variables;
  std::uint8_t detail = 0;  ///< bit number of a bit operand; else as the opcode says
  ElementaryType type = ElementaryType::boolean;
  std::uint32_t offset = 0;
};
static_assert(sizeof(Instruction) == 8, "eight of them share a cache line");

struct IlVariable {
  std::string name;  ///< in capitals
  VariableSection section = VariableSection::local;
  ElementaryType type = ElementaryType::boolean;
  Area area = Area::variables;
  std::uint32_t offset = 0;
  std::uint8_t bit_index = 0;
};

/// The value that `x AT %QX0.0 : BOOL := TRUE` asks for at a cold start.
struct ImageInitial {
  Area area = Area::outputs;
  ElementaryType type = ElementaryType::boolean;
  std::uint32_t offset = 0;
  std::uint8_t bit_index = 0;
  std::uint64_t bits = 0;
};

struct IlProgram {
  std::string name;
  std::vector<Instruction> code;    ///< ends with end_scan
  std::vector<SourcePlace> places;  ///< of each instruction of the code
  std::vector<std::uint64_t> constants;
  std::vector<std::byte> initial_variables;  ///< retained ones first
  std::size_t retained_bytes = 0;
  std::array<std::size_t, areas_count> image_bytes_needed{};  ///< of inputs, outputs, memory
  std::vector<ImageInitial> image_initials;
  std::vector<IlVariable> variables;  ///< all but instances of function blocks
  /// What is allowed and may surprise: a use of CR after CAL.
  std::vector<IlError> warnings;

  /// @param upper_name  in capitals
  /// @return            nullptr when there is none
  [[nodiscard]] const IlVariable* find(std::string_view upper_name) const noexcept {
    for (const IlVariable& variable : variables) {
      if (variable.name == upper_name) return &variable;
    }
    return nullptr;
  }
};

}  // namespace emulator_models::soft_plc
