// What a block may do after the blocks before it: which motion is in force, whether a feed is given, and
// which word is used by what.
//
// The third step of the rules (nc_rules.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "kernel_mocks/g_codes.hpp"
#include "kernel_mocks/nc_error.hpp"
#include "kernel_mocks/nc_lexer.hpp"

namespace kernel_mocks {

class ModalRules {
 public:
  /// To be called for each block in the order of the program.
  /// @param words  passed check_word() and check_block()
  [[nodiscard]] std::optional<NcError> check(std::span<const LexedWord> words, std::uint32_t line);

 private:
  struct BlockFacts;

  void take_modes(const BlockFacts& facts) noexcept;
  [[nodiscard]] bool is_arc(const BlockFacts& facts) const noexcept;
  [[nodiscard]] std::optional<NcError> check_motion(const BlockFacts& facts, std::uint32_t line) const;
  [[nodiscard]] std::optional<NcError> check_users(const BlockFacts& facts, std::uint32_t line) const;

  /// The motion in force; G80 (none) until the program chooses one.
  GTenths motion_ = 800;
  GTenths feed_mode_ = 940;
  bool feed_is_set_ = false;
};

}  // namespace kernel_mocks
