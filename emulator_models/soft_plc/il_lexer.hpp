// Splits an instruction-list source into tokens, each with its place.
//
// Line ends are tokens, since an instruction ends with its line. Comments (* ... *) may span lines and do not
// nest (edition 2); a comment is a blank, so a line end within one does not end an instruction.
// Literals are recognised here and valued in il_literal.hpp. Tokens point into the source.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/il_error.hpp"

namespace emulator_models::soft_plc {

enum class TokenKind : std::uint8_t {
  identifier,      ///< also keywords and operators; & is AND, &N is ANDN
  literal,         ///< 5, -16#FF, INT#5, T#1s, 1.5E3; TRUE and FALSE are identifiers
  direct_address,  ///< %IX0.0
  colon,
  semicolon,
  comma,
  dot,
  left_parenthesis,
  right_parenthesis,
  assign,  ///< :=
  arrow,   ///< =>
  line_end,
  end,  ///< always the last token, and only there
};

struct Token {
  TokenKind kind = TokenKind::end;
  std::string_view text;
  SourcePlace place;
};

/// The same text in capitals (ASCII): names and keywords are compared so.
[[nodiscard]] std::string upper(std::string_view text);

/// @return the tokens; or the first character that begins none, or a comment without an end
[[nodiscard]] tl::expected<std::vector<Token>, IlError> tokenize(std::string_view source);

}  // namespace emulator_models::soft_plc
