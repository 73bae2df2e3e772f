#include "kernel_mocks/nc_program.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace kernel_mocks {

std::string to_string(const Word& word) { return word.letter + to_string(word.value); }

const Word* Block::find(char letter) const noexcept {
  const auto found = std::ranges::find(words, letter, &Word::letter);
  return found == words.end() ? nullptr : &*found;
}

std::string name_of(const Block& block) {
  return block.number ? fmt::format("N{}", *block.number) : fmt::format("line {}", block.line);
}

}  // namespace kernel_mocks
