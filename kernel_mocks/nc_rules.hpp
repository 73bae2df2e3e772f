// What makes the words of a block a block that this control can carry out.
//
// Three steps: every word by itself, the words of one block together, and the block after those before it
// (modal_rules.hpp). The first fault in that order is reported. The rules are those that LinuxCNC's
// interpreter was observed to apply (README.md lists them), with one leaning: what would have to be guessed
// is refused.
//
// Not here: whether the machine has a function (block_plan.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "kernel_mocks/nc_error.hpp"
#include "kernel_mocks/nc_lexer.hpp"

namespace kernel_mocks {

inline constexpr unsigned m_code_max = 199;
inline constexpr unsigned m_codes_per_block_max = 4;

/// A word by itself: range, whole number, known code.
[[nodiscard]] std::optional<NcFault> check_word(const LexedWord& word) noexcept;

/// The words of one block together: none repeated, one code of each modal group.
/// @param words  each passed check_word()
[[nodiscard]] std::optional<NcError> check_block(std::span<const LexedWord> words, std::uint32_t line);

}  // namespace kernel_mocks
