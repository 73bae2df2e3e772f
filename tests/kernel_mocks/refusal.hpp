// Shorthand of the parser tests: a program's refusal as text.
#pragma once

#include <string>
#include <string_view>

#include "kernel_mocks/nc_parser.hpp"

namespace kernel_mocks {

/// "" when the program is accepted, otherwise the error as the user reads it.
inline std::string refusal(std::string_view text, ParserOptions options = {}) {
  const auto program = parse_program(text, options);
  return program ? "" : to_string(program.error());
}

/// The same of one block, which the shortest possible program surrounds: it is line 2.
inline std::string refusal_of_block(std::string_view block) {
  return refusal("%\n" + std::string{block} + "\n%\n");
}

}  // namespace kernel_mocks
