#include "kernel_mocks/nc_lexer.hpp"

#include <optional>

#include <fmt/format.h>

namespace kernel_mocks {
namespace {

constexpr bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\r'; }
constexpr bool is_number_part(char c) noexcept {
  return (c >= '0' && c <= '9') || c == '.' || c == '+' || c == '-';
}
constexpr bool is_expression_sign(char c) noexcept {
  return c == '[' || c == ']' || c == '#' || c == '=' || c == '<' || c == '>';
}
constexpr char upper(char c) noexcept { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
constexpr bool is_letter(char c) noexcept { return upper(c) >= 'A' && upper(c) <= 'Z'; }

std::string shown(char c) {
  const auto code = static_cast<unsigned char>(c);
  return code > 0x20 && code < 0x7F ? std::string(1, c) : fmt::format("\\x{:02X}", code);
}

class LineLexer {
 public:
  LineLexer(std::string_view line, std::uint32_t line_number) : rest_{line}, line_number_{line_number} {}

  tl::expected<LexedLine, NcError> run() {
    LexedLine result;
    for (bool at_start = true;; at_start = false) {
      if (const auto fault = skip_blanks_and_comments()) return tl::unexpected{*fault};
      if (rest_.empty()) return result;
      if (at_start && rest_.front() == '/') {
        result.optional_skip = true;
        rest_.remove_prefix(1);
        continue;
      }
      auto word = next_word();
      if (!word) return tl::unexpected{word.error()};
      result.words.push_back(std::move(*word));
    }
  }

 private:
  NcError error(NcFault fault, std::string word) const { return {fault, line_number_, std::move(word)}; }

  std::optional<NcError> skip_blanks_and_comments() {
    while (!rest_.empty()) {
      if (is_blank(rest_.front())) {
        rest_.remove_prefix(1);
      } else if (rest_.front() == ';') {
        rest_ = {};
      } else if (rest_.front() == '(') {
        const std::size_t end = rest_.find_first_of("()", 1);
        if (end == std::string_view::npos) return error(NcFault::comment_not_closed, "(");
        if (rest_[end] == '(') return error(NcFault::comment_in_comment, "(");
        rest_.remove_prefix(end + 1);
      } else {
        break;
      }
    }
    return std::nullopt;
  }

  tl::expected<LexedWord, NcError> next_word() {
    const char first = rest_.front();
    if (!is_letter(first) && first != ':') return tl::unexpected{error_at(first)};
    rest_.remove_prefix(1);
    std::string text(1, first);
    for (; !rest_.empty() && (is_blank(rest_.front()) || is_number_part(rest_.front()));
         rest_.remove_prefix(1)) {
      if (!is_blank(rest_.front())) text += rest_.front();
    }
    if (text.size() == 1) {
      // O<name> and T#1 are better called what they are than a missing number.
      if (upper(first) == 'O') return tl::unexpected{error(NcFault::o_word, text)};
      if (!rest_.empty() && is_expression_sign(rest_.front())) {
        return tl::unexpected{error(NcFault::expression, text + rest_.front())};
      }
      return tl::unexpected{error(NcFault::word_without_number, text)};
    }
    const auto value = Decimal::parse(std::string_view{text}.substr(1));
    if (!value) {
      return tl::unexpected{error(
          value.error() == DecimalError::not_a_number ? NcFault::not_a_number : NcFault::too_many_digits,
          text)};
    }
    // "o100 sub": to complain about the S would hide what the line is.
    if (upper(first) == 'O' && (skip_blanks_and_comments() || !rest_.empty())) {
      return tl::unexpected{error(NcFault::o_word, text)};
    }
    return LexedWord{upper(first), *value, std::move(text)};
  }

  NcError error_at(char c) const {
    if (c == ')') return error(NcFault::comment_not_opened, ")");
    if (c == '/') return error(NcFault::skip_not_at_start, "/");
    if (is_expression_sign(c)) return error(NcFault::expression, shown(c));
    if (is_number_part(c)) return error(NcFault::word_without_number, shown(c));
    return error(NcFault::bad_character, shown(c));
  }

  std::string_view rest_;
  std::uint32_t line_number_;
};

}  // namespace

tl::expected<LexedLine, NcError> lex_line(std::string_view line, std::uint32_t line_number) {
  return LineLexer{line, line_number}.run();
}

}  // namespace kernel_mocks
