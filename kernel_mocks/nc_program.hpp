// A part program after parsing: blocks of words.
//
// A block keeps its words in the order in which they were written; what acts when is decided by meaning, not
// by position (block_plan.hpp). Comments are gone: they are for the reader of the file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernel_mocks/decimal.hpp"

namespace kernel_mocks {

struct Word {
  char letter = 'N';  ///< 'A' to 'Z', never N: the block number is Block::number
  Decimal value;

  bool operator==(const Word&) const = default;
};

/// "M3", "X-0.5": upper case, without superfluous zeros.
[[nodiscard]] std::string to_string(const Word& word);

struct Block {
  /// Line of the file, from 1.
  std::uint32_t line = 0;
  /// Value of the N word or of the alignment block's colon.
  std::optional<std::uint32_t> number;
  /// Began with `:`: a place at which a run may be taken up again.
  bool alignment = false;
  /// Began with `/`.
  bool optional_skip = false;
  std::vector<Word> words;

  /// The first word with this letter, or nullptr.
  [[nodiscard]] const Word* find(char letter) const noexcept;

  bool operator==(const Block&) const = default;
};

/// How a block is named to people: "N40", or "line 12" where it has no number.
[[nodiscard]] std::string name_of(const Block& block);

struct Program {
  /// Value of the program number word (O1234) or of %1234.
  std::optional<std::uint32_t> number;
  /// Blocks with words, in order. Ends with the block that ends the program, or before the closing %.
  std::vector<Block> blocks;
};

}  // namespace kernel_mocks
