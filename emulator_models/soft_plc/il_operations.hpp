// What the operators of instruction list compute, on values as the accumulator holds them (il_types.hpp).
//
// Integers wrap at the width of their type. Division by zero is a fault for integers and reals alike: edition 2
// calls it an error, and an infinity that travels on is found far from its cause.
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/il_types.hpp"

namespace emulator_models::soft_plc {

enum class Operation : std::uint8_t {
  bit_and,
  bit_or,
  bit_xor,
  add,
  sub,
  mul,
  div,
  mod,
  greater,
  greater_equal,
  equal,
  not_equal,
  less_equal,
  less,
  minimum,
  maximum,
};

/// Comparisons yield a BOOL, all others the type of their operands.
[[nodiscard]] constexpr bool is_comparison(Operation operation) noexcept {
  return operation >= Operation::greater && operation <= Operation::less;
}

/// An operator that takes an operand or puts off its work until a parenthesis is closed.
struct NamedOperation {
  std::string_view name;
  Operation operation;
  bool negated;  ///< the operand is
};
/// @return nullptr for other operators
[[nodiscard]] const NamedOperation* find_operation(std::string_view upper_name) noexcept;

enum class ShiftKind : std::uint8_t { left, right, rotate_left, rotate_right };

enum class FaultKind : std::uint8_t {
  division_by_zero,
  budget_spent,             ///< more instructions in one scan than allowed: an endless loop, as a rule
  conversion_out_of_range,  ///< REAL_TO_INT of 1.0E9, or of no number
  negative_shift,
  image_too_small,  ///< the program uses an address beyond the process image
};
[[nodiscard]] std::string_view to_string(FaultKind kind) noexcept;

using OperationResult = tl::expected<std::uint64_t, FaultKind>;

/// left OP right, both of `type`. Comparisons yield 0 or 1; one with a NaN is false, save not_equal.
/// @param type  one that has the operation: the compiler has seen to it
[[nodiscard]] OperationResult operate(Operation operation, ElementaryType type, std::uint64_t left,
                                      std::uint64_t right) noexcept;

/// ABS of a number; of the least signed integer that integer itself (it wraps).
[[nodiscard]] std::uint64_t absolute(ElementaryType type, std::uint64_t value) noexcept;

/// Integers and bit strings: the low bits, as in a store of that width. Any number to BOOL: not zero. Reals are
/// rounded to the nearest integer, the even one of two. TIME counts as milliseconds, cut off.
[[nodiscard]] OperationResult convert(ElementaryType from, ElementaryType to, std::uint64_t value) noexcept;

/// @param type   BYTE, WORD, DWORD or LWORD
/// @param count  as loaded; a shift by the width or more gives 0, a rotation counts modulo the width
[[nodiscard]] OperationResult shift(ShiftKind kind, ElementaryType type, std::uint64_t value,
                                    ElementaryType count_type, std::uint64_t count) noexcept;

}  // namespace emulator_models::soft_plc
