// One line of ISO-7bit text, cut into words.
//
//   line   = [ "/" ] word...        blanks, tabs and CR anywhere are ignored, also inside a number
//   word   = letter number | ":" number
//   number = [ "+" | "-" ] digits [ "." digits ], at least one digit
//
// Comments in parentheses and from ; to the end of the line are dropped. Lower case counts as upper case.
// Sources: ISO 6983-1, GOST 20999-83, EIA RS-274-D (README.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "kernel_mocks/decimal.hpp"
#include "kernel_mocks/nc_error.hpp"

namespace kernel_mocks {

struct LexedWord {
  char letter = 0;  ///< 'A' to 'Z', or ':'
  Decimal value;
  std::string text;  ///< as written, without blanks
};

struct LexedLine {
  bool optional_skip = false;
  std::vector<LexedWord> words;
};

/// @param line         without its line feed
/// @param line_number  for the error
[[nodiscard]] tl::expected<LexedLine, NcError> lex_line(std::string_view line, std::uint32_t line_number);

}  // namespace kernel_mocks
