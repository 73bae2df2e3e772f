#include "kernel_mocks/nc_parser.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "kernel_mocks/modal_rules.hpp"
#include "kernel_mocks/nc_lexer.hpp"
#include "kernel_mocks/nc_rules.hpp"

namespace kernel_mocks {
namespace {

std::string_view without_leading_blanks(std::string_view line) noexcept {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view{} : line.substr(first);
}

bool ends_program(const Block& block) noexcept {
  return std::ranges::any_of(block.words, [](const Word& word) {
    return word.letter == 'M' &&
           (word.value.whole() == 2 || word.value.whole() == 30 || word.value.whole() == 99);
  });
}

class ProgramReader {
 public:
  ProgramReader(std::string_view text, ParserOptions options) : rest_{text}, options_{options} {}

  tl::expected<Program, NcError> run() {
    while (!ended_ && !rest_.empty()) {
      ++line_number_;
      const std::size_t feed = rest_.find('\n');
      const std::string_view line = rest_.substr(0, feed);
      rest_ = feed == std::string_view::npos ? std::string_view{} : rest_.substr(feed + 1);
      if (line.size() > line_bytes_max) return refuse(NcFault::line_too_long);
      if (auto error = take(line)) return tl::unexpected{std::move(*error)};
    }
    if (!ended_) return refuse(NcFault::no_program_end);
    return std::move(program_);
  }

 private:
  tl::unexpected<NcError> refuse(NcFault fault) const {
    return tl::unexpected{NcError{fault, std::max(line_number_, 1U), ""}};
  }

  std::optional<NcError> take(std::string_view line) {
    const std::string_view content = without_leading_blanks(line);
    if (!content.empty() && content.front() == '%') return take_percent(content.substr(1));
    if (options_.skip_optional_blocks && !content.empty() && content.front() == '/') return std::nullopt;
    auto lexed = lex_line(line, line_number_);
    if (!lexed) return std::move(lexed.error());
    if (lexed->words.empty()) return std::nullopt;
    return take_block(*lexed);
  }

  // The first % opens the program, the second closes it. Without a first one the file is all program.
  std::optional<NcError> take_percent(std::string_view after) {
    const bool closes = opened_ || !program_.blocks.empty();
    if (closes && !opened_) return NcError{NcFault::bad_character, line_number_, "%"};
    if (closes) {
      ended_ = true;
      return std::nullopt;
    }
    opened_ = true;
    // %1234 is a program number as : and O are elsewhere; read it as if it were one.
    std::string_view number = without_leading_blanks(after);
    if (number.empty() || number.front() == '(' || number.front() == ';') {
      auto comment = lex_line(after, line_number_);
      if (!comment) return std::move(comment.error());
      if (!comment->words.empty()) return NcError{NcFault::text_after_percent, line_number_, "%"};
      return std::nullopt;
    }
    std::string as_word(1, ':');
    as_word += number;
    const auto lexed = lex_line(as_word, line_number_);
    if (!lexed || lexed->words.size() != 1 || check_word(lexed->words.front())) {
      return NcError{NcFault::text_after_percent, line_number_, "%"};
    }
    program_.number = static_cast<std::uint32_t>(lexed->words.front().value.whole());
    return std::nullopt;
  }

  std::optional<NcError> take_block(const LexedLine& lexed) {
    if (is_program_number(lexed)) {
      program_.number = static_cast<std::uint32_t>(lexed.words.front().value.whole());
      return std::nullopt;
    }
    for (const LexedWord& word : lexed.words) {
      if (const auto fault = check_word(word)) return NcError{*fault, line_number_, word.text};
    }
    if (auto error = check_block(lexed.words, line_number_)) return error;
    if (auto error = modal_.check(lexed.words, line_number_)) return error;
    if (program_.blocks.size() == blocks_max) return NcError{NcFault::too_many_blocks, line_number_, ""};
    Block& block = program_.blocks.emplace_back();
    block.line = line_number_;
    block.optional_skip = lexed.optional_skip;
    for (const LexedWord& word : lexed.words) {
      if (word.letter == 'N' || word.letter == ':') {
        block.number = static_cast<std::uint32_t>(word.value.whole());
        block.alignment = word.letter == ':';
      } else {
        block.words.push_back({word.letter, word.value});
      }
    }
    ended_ = ends_program(block);
    return std::nullopt;
  }

  bool is_program_number(const LexedLine& lexed) const noexcept {
    return program_.blocks.empty() && !program_.number && !lexed.optional_skip && lexed.words.size() == 1 &&
           lexed.words.front().letter == 'O' && lexed.words.front().value.is_whole() &&
           !lexed.words.front().value.is_negative();
  }

  std::string_view rest_;
  ParserOptions options_;
  std::uint32_t line_number_ = 0;
  bool opened_ = false;
  bool ended_ = false;
  ModalRules modal_;
  Program program_;
};

}  // namespace

tl::expected<Program, NcError> parse_program(std::string_view text, ParserOptions options) {
  return ProgramReader{text, options}.run();
}

}  // namespace kernel_mocks
