#include "emulator_models/soft_plc/il_lexer.hpp"

#include <optional>

namespace emulator_models::soft_plc {
namespace {

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
bool is_letter(char c) noexcept { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_word(char c) noexcept { return is_digit(c) || is_letter(c); }
bool is_sign(char c) noexcept { return c == '-' || c == '+'; }

class Lexer {
 public:
  explicit Lexer(std::string_view source) noexcept : source_{source} {}

  tl::expected<std::vector<Token>, IlError> run() {
    while (position_ < source_.size()) {
      if (auto error = next()) return tl::unexpected(std::move(*error));
    }
    tokens_.push_back({TokenKind::line_end, {}, place_});
    tokens_.push_back({TokenKind::end, {}, place_});
    return std::move(tokens_);
  }

 private:
  [[nodiscard]] char peek(std::size_t ahead = 0) const noexcept {
    return position_ + ahead < source_.size() ? source_[position_ + ahead] : '\0';
  }

  void advance() noexcept {
    if (source_[position_++] == '\n') {
      ++place_.line;
      place_.column = 1;
    } else {
      ++place_.column;
    }
  }

  void take(TokenKind kind, std::size_t length) {
    tokens_.push_back({kind, source_.substr(position_, length), place_});
    for (std::size_t i = 0; i < length; ++i) advance();
  }

  [[nodiscard]] std::optional<IlError> next() {
    const char c = peek();
    if (c == '\n') {
      take(TokenKind::line_end, 1);
    } else if (c == ' ' || c == '\t' || c == '\r') {
      advance();
    } else if (c == '(' && peek(1) == '*') {
      return skip_comment();
    } else if (is_digit(c) || (is_sign(c) && is_digit(peek(1)))) {
      take(TokenKind::literal, number_length(is_sign(c) ? 1 : 0));
    } else if (is_letter(c)) {
      take_word();
    } else if (c == '%') {
      take(TokenKind::direct_address, address_length());
    } else if (c == '&') {
      take_ampersand();
    } else {
      return take_punctuation();
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<IlError> skip_comment() {
    const SourcePlace begin = place_;
    const std::size_t end = source_.find("*)", position_ + 2);
    if (end == std::string_view::npos) return IlError{begin, "this comment has no end: close it with *)"};
    while (position_ < end + 2) advance();
    return std::nullopt;
  }

  /// From a sign or digit on. A sign within a number belongs to its exponent; in 16#1E it cannot follow.
  [[nodiscard]] std::size_t number_length(std::size_t length) const noexcept {
    bool based = false;
    for (;; ++length) {
      const char c = peek(length);
      if (c == '#') based = true;
      const bool exponent_sign = is_sign(c) && !based && (peek(length - 1) == 'e' || peek(length - 1) == 'E');
      if (!is_word(c) && c != '.' && c != '#' && !exponent_sign) return length;
    }
  }

  void take_word() {
    std::size_t length = 1;
    while (is_word(peek(length))) ++length;
    if (peek(length) != '#') {
      take(TokenKind::identifier, length);
      return;
    }
    ++length;
    if (is_sign(peek(length))) ++length;
    take(TokenKind::literal, number_length(length));
  }

  [[nodiscard]] std::size_t address_length() const noexcept {
    std::size_t length = 1;
    while (is_word(peek(length)) || (peek(length) == '.' && is_digit(peek(length + 1)))) ++length;
    return length;
  }

  void take_ampersand() {
    const bool negated = (peek(1) == 'N' || peek(1) == 'n') && !is_word(peek(2));
    const SourcePlace place = place_;
    tokens_.push_back({TokenKind::identifier, negated ? "ANDN" : "AND", place});
    advance();
    if (negated) advance();
  }

  [[nodiscard]] std::optional<IlError> take_punctuation() {
    switch (peek()) {
      case ':':
        if (peek(1) == '=') {
          take(TokenKind::assign, 2);
        } else {
          take(TokenKind::colon, 1);
        }
        return std::nullopt;
      case '=':
        if (peek(1) != '>') break;
        take(TokenKind::arrow, 2);
        return std::nullopt;
      case ';':
        take(TokenKind::semicolon, 1);
        return std::nullopt;
      case ',':
        take(TokenKind::comma, 1);
        return std::nullopt;
      case '.':
        take(TokenKind::dot, 1);
        return std::nullopt;
      case '(':
        take(TokenKind::left_parenthesis, 1);
        return std::nullopt;
      case ')':
        take(TokenKind::right_parenthesis, 1);
        return std::nullopt;
      case '/':
        if (peek(1) == '/') return IlError{place_, "instruction list has no // comments: write (* ... *)"};
        break;
      case '\'':
      case '"':
        return IlError{place_, "this PLC has no strings: use numbers or bit strings"};
      default:
        break;
    }
    return unknown_character();
  }

  [[nodiscard]] IlError unknown_character() const {
    const char c = peek();
    const bool printable = c > ' ' && c < '\x7f';
    const std::string shown =
        printable ? std::string{"'"} + c + "'" : "byte " + std::to_string(static_cast<unsigned char>(c));
    return {place_, shown + " begins nothing in instruction list: remove it or put it into a comment (* *)"};
  }

  std::string_view source_;
  std::size_t position_ = 0;
  SourcePlace place_;
  std::vector<Token> tokens_;
};

}  // namespace

std::string upper(std::string_view text) {
  std::string result{text};
  for (char& c : result) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return result;
}

tl::expected<std::vector<Token>, IlError> tokenize(std::string_view source) { return Lexer{source}.run(); }

}  // namespace emulator_models::soft_plc
