#include "protocol/toml_nesting.hpp"

#include <algorithm>

namespace protocol {
namespace {

class NestingScanner {
 public:
  explicit NestingScanner(std::string_view toml) noexcept : text_{toml} {}

  std::optional<TomlPlace> run() noexcept {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string(c);
      } else if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (is_one_too_many(c)) {
        return place();
      } else {
        ++at_;
      }
    }
    return std::nullopt;
  }

 private:
  bool is_one_too_many(char c) noexcept {
    switch (c) {
      case '[':
      case '{':
        dots_ = 0;
        return ++brackets_ > toml_nesting_max;
      case ']':
      case '}':
        dots_ = 0;
        if (brackets_ > 0) --brackets_;
        return false;
      case '.':
        return ++dots_ >= toml_nesting_max;
      case '=':
      case ',':
      case '\n':
        dots_ = 0;
        return false;
      default:
        return false;
    }
  }

  void skip_string(char quote) noexcept {
    const bool is_multi_line = quotes_at(at_, quote) >= 3;
    at_ += is_multi_line ? 3 : 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\\' && quote == '"') {
        at_ = std::min(at_ + 2, text_.size());
      } else if (c == quote && is_multi_line) {
        // Up to two quotes may stand before the three that close it.
        const std::size_t quotes = std::min<std::size_t>(quotes_at(at_, quote), 5);
        at_ += quotes;
        if (quotes >= 3) return;
      } else if (c == quote || (c == '\n' && !is_multi_line)) {
        at_ += c == quote ? 1 : 0;
        return;
      } else {
        ++at_;
      }
    }
  }

  [[nodiscard]] std::size_t quotes_at(std::size_t begin, char quote) const noexcept {
    return std::min(text_.find_first_not_of(quote, begin), text_.size()) - begin;
  }

  [[nodiscard]] TomlPlace place() const noexcept {
    const std::string_view before = text_.substr(0, at_);
    const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 = 0: the first line
    return {static_cast<std::uint32_t>(1 + std::ranges::count(before, '\n')),
            static_cast<std::uint32_t>(at_ - line_begin + 1)};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  unsigned brackets_ = 0;
  unsigned dots_ = 0;
};

}  // namespace

std::optional<TomlPlace> too_deep_nesting(std::string_view toml) noexcept {
  return NestingScanner{toml}.run();
}

}  // namespace protocol
