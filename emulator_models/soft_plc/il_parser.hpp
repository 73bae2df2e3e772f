// From tokens to the syntax tree: PROGRAM, VAR blocks, one instruction a line, END_PROGRAM.
//
// What an instruction means is il_compiler.hpp's. Only the form differs between operators: AND( x defers,
// CAL t( ... ) and MAX( ... ) call; within the parentheses of a call, line ends do not count.
#pragma once

#include <string_view>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/il_syntax.hpp"

namespace emulator_models::soft_plc {

/// @param source  must outlive the tree, which points into it
/// @return        the tree; or the first place that has not the form of a program
[[nodiscard]] tl::expected<SyntaxTree, IlError> parse(std::string_view source);

/// Operators of edition 2, keywords and types: no names of variables, labels or programs.
[[nodiscard]] bool is_reserved(std::string_view upper_name) noexcept;

}  // namespace emulator_models::soft_plc
