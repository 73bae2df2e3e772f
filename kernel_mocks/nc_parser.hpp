// Reads a part program in ISO-7bit (ISO 6983-1, GOST 20999-83, EIA RS-274-D).
//
// The text is taken from memory and returned as a value; the first fault ends the reading. After the block
// with M2, M30 or M99 nothing is looked at, nor after a second %. What this control does not support is
// refused by line and word, never skipped: README.md lists it.
//
// Bounds: line_bytes_max, blocks_max, the digits of a number (decimal.hpp), M codes of a block
// (nc_rules.hpp).
#pragma once

#include <cstddef>
#include <string_view>

#include <tl/expected.hpp>

#include "kernel_mocks/nc_error.hpp"
#include "kernel_mocks/nc_program.hpp"

namespace kernel_mocks {

/// Longest line without its line feed. LinuxCNC takes 255; long comments go beyond.
inline constexpr std::size_t line_bytes_max = 512;
inline constexpr std::size_t blocks_max = 1'000'000;

struct ParserOptions {
  /// The operator's switch for `/`: on, such blocks are not read at all; off, they are blocks like others.
  bool skip_optional_blocks = false;
};

[[nodiscard]] tl::expected<Program, NcError> parse_program(std::string_view text, ParserOptions options = {});

}  // namespace kernel_mocks
