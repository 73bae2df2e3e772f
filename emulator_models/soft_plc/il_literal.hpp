// Values of literals: 5, -5, 16#FF, 2#1010_0101, INT#5, WORD#16#FFFF, BOOL#1, TRUE, 1.5E3, T#1h2m3.5s.
//
// A literal without a type takes the one its context asks for, if its value fits; one with a type keeps it.
// An integer is no real: where a REAL is asked for, write 5.0 or REAL#5.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/il_types.hpp"

namespace emulator_models::soft_plc {

struct Literal {
  enum class Kind : std::uint8_t { integer, real, duration };

  Kind kind = Kind::integer;
  /// As written: INT#5 has one, 5 has none; TRUE is a BOOL, T#1s a TIME.
  std::optional<ElementaryType> type;
  bool negative = false;
  std::uint64_t magnitude = 0;  ///< of an integer
  double real = 0.0;            ///< sign included
  std::int64_t duration_ns = 0;
};

/// @param text  one token of the kind `literal`, or TRUE or FALSE
/// @return      the literal; or what is wrong with it and the way out
[[nodiscard]] tl::expected<Literal, std::string> parse_literal(std::string_view text);

/// @return the value as the accumulator holds it; or why the literal is none of `type`
[[nodiscard]] tl::expected<std::uint64_t, std::string> value_as(const Literal& literal, ElementaryType type);

}  // namespace emulator_models::soft_plc
