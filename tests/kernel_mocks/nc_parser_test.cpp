// The whole part program: its frame of % signs, its end, its blocks, its limits.
#include "kernel_mocks/nc_parser.hpp"

#include <algorithm>
#include <cstdint>
#include <set>

#include <gtest/gtest.h>

#include "tests/kernel_mocks/refusal.hpp"

namespace kernel_mocks {
namespace {

const std::string no_end = ": the file ends without M2, M30, M99 or a closing %: it may be cut off";

TEST(NcParser, reads_blocks_with_their_lines_and_numbers) {
  const auto program = parse_program("%\nN10 G0 X1.5\n\n(comment)\nM3 S500\nM30\n%\n");
  ASSERT_TRUE(program.has_value()) << to_string(program.error());
  ASSERT_EQ(program->blocks.size(), 3U);
  EXPECT_EQ(program->blocks[0].line, 2U);
  EXPECT_EQ(program->blocks[0].number, 10U);
  EXPECT_EQ(program->blocks[0].words,
            (std::vector<Word>{{'G', Decimal::from_whole(0)}, {'X', *Decimal::parse("1.5")}}));
  EXPECT_EQ(program->blocks[1].line, 5U);
  EXPECT_EQ(program->blocks[1].number, std::nullopt);
  EXPECT_EQ(name_of(program->blocks[0]), "N10");
  EXPECT_EQ(name_of(program->blocks[1]), "line 5");
}

TEST(NcParser, a_colon_is_an_alignment_block_with_a_number) {
  const auto program = parse_program(":7 M3\nM30");
  ASSERT_TRUE(program.has_value()) << to_string(program.error());
  EXPECT_EQ(program->blocks[0].number, 7U);
  EXPECT_TRUE(program->blocks[0].alignment);
  EXPECT_FALSE(program->blocks[1].alignment);
}

TEST(NcParser, line_ends_may_be_those_of_windows) { EXPECT_EQ(refusal("%\r\nM3\r\nM30\r\n%\r\n"), ""); }

TEST(NcParser, the_last_line_needs_no_line_feed) { EXPECT_EQ(refusal("M30"), ""); }

TEST(NcParser, a_program_ends_with_m2_m30_or_m99) {
  EXPECT_EQ(refusal("M3\nM2"), "");
  EXPECT_EQ(refusal("M3\nM30"), "");
  EXPECT_EQ(refusal("M3\nM99"), "");
}

TEST(NcParser, a_program_between_percent_signs_needs_no_m_code_at_its_end) {
  EXPECT_EQ(refusal("%\nM3\n%"), "");
}

TEST(NcParser, a_file_that_may_be_cut_off_is_refused) {
  EXPECT_EQ(refusal("M3\nG0 X1\n"), "line 2" + no_end);
  EXPECT_EQ(refusal("%\nM3\n"), "line 2" + no_end);
  EXPECT_EQ(refusal(""), "line 1" + no_end);
}

TEST(NcParser, nothing_is_looked_at_after_the_end_of_the_program) {
  EXPECT_EQ(refusal("M30\nO100 sub ["), "");
  EXPECT_EQ(refusal("%\nM3\n%\nthe rest of the tape"), "");
}

TEST(NcParser, a_percent_sign_without_a_first_one_is_refused) {
  EXPECT_EQ(refusal("M3\n%\n"), "line 2, word '%': not a character of the ISO-7bit program code");
}

TEST(NcParser, the_first_percent_sign_may_carry_a_program_number_or_a_comment) {
  EXPECT_EQ(parse_program("%1234\nM30\n%")->number, 1234U);
  EXPECT_EQ(refusal("% (bracket)\nM30\n%"), "");
  EXPECT_EQ(refusal("%MPF\nM30\n%"),
            "line 1, word '%': after % only a program number or a comment may follow in the line");
}

TEST(NcParser, an_o_word_alone_in_the_first_block_is_the_program_number) {
  EXPECT_EQ(parse_program("%\nO0012 (bracket)\nM30\n%")->number, 12U);
}

TEST(NcParser, an_o_word_anywhere_else_is_refused) {
  const std::string reason =
      ": O words (subroutines, branches, loops) are not supported; a program number stands alone in the "
      "first "
      "block";
  EXPECT_EQ(refusal("M3\nO100\nM30"), "line 2, word 'O100'" + reason);
  EXPECT_EQ(refusal("O1\nO2\nM30"), "line 2, word 'O2'" + reason);
  EXPECT_EQ(refusal("O-1\nM30"), "line 1, word 'O-1'" + reason);
}

TEST(NcParser, optional_blocks_are_blocks_while_the_switch_is_off) {
  const auto program = parse_program("/M8\nM30");
  ASSERT_TRUE(program.has_value());
  EXPECT_EQ(program->blocks.size(), 2U);
  EXPECT_TRUE(program->blocks[0].optional_skip);
}

TEST(NcParser, optional_blocks_are_not_read_at_all_while_the_switch_is_on) {
  const auto program = parse_program("/M8 [whatever]\n/M30\nM5\nM30", {.skip_optional_blocks = true});
  ASSERT_TRUE(program.has_value()) << to_string(program.error());
  EXPECT_EQ(program->blocks.size(), 2U);
}

TEST(NcParser, an_optional_program_end_ends_the_program_while_the_switch_is_off) {
  EXPECT_EQ(parse_program("/M30\nM5\nM30")->blocks.size(), 1U);
}

TEST(NcParser, takes_a_line_of_512_characters_and_not_of_513) {
  static_assert(line_bytes_max == 512);
  const std::string comment = "(" + std::string(510, 'a') + ")";
  EXPECT_EQ(refusal(comment + "\nM30"), "");
  EXPECT_EQ(refusal(comment + " \nM30"), "line 1: a line has at most 512 characters");
}

TEST(NcParser, takes_a_million_blocks_and_not_one_more) {
  static_assert(blocks_max == 1'000'000);
  std::string text;
  for (std::size_t count = 1; count < blocks_max; ++count) text += "M3\n";
  EXPECT_EQ(refusal(text + "M30"), "");
  EXPECT_EQ(refusal(text + "M3\nM30"), "line 1000001: a program has at most 1000000 blocks");
}

TEST(NcParser, the_first_fault_is_the_one_reported) {
  EXPECT_EQ(refusal("M3\nM3.5\nM4 M3"), "line 2, word 'M3.5': an M code is a whole number from 0 to 199");
}

TEST(NcParser, the_message_shows_the_word_as_it_was_written) {
  EXPECT_EQ(refusal("\n\nm 0 3 . 5\nM30"), "line 3, word 'm03.5': an M code is a whole number from 0 to 199");
}

TEST(NcParser, every_fault_has_its_own_text) {
  std::set<std::string_view> texts;
  for (unsigned number = 0; number <= static_cast<unsigned>(NcFault::does_not_fit_plc_word); ++number) {
    texts.insert(to_string(static_cast<NcFault>(number)));
  }
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(NcFault::does_not_fit_plc_word) + 1);
}

// Multiplicative generator of Park and Miller: the texts are the same on every machine.
class TextMaker {
 public:
  explicit TextMaker(std::uint32_t seed) : state_{seed} {}
  std::string make(std::size_t length, std::string_view alphabet) {
    std::string text(length, ' ');
    for (char& c : text) c = alphabet[next() % alphabet.size()];
    return text;
  }

 private:
  std::uint32_t next() {
    state_ = static_cast<std::uint32_t>(std::uint64_t{state_} * 48271 % 2147483647);
    return state_ >> 4U;
  }
  std::uint32_t state_;
};

TEST(NcParser, any_bytes_are_either_read_or_refused_with_a_line) {
  std::string all_bytes;
  for (int byte = 0; byte < 256; ++byte) all_bytes += static_cast<char>(byte);
  const std::string program_like = "NGXYZMSTFIJKR0123456789.-+ \n\n%/:();O#[]";
  TextMaker maker{1};
  std::size_t accepted = 0;
  for (int round = 0; round < 20'000; ++round) {
    const std::string text =
        maker.make(static_cast<std::size_t>(round % 120), round % 2 ? all_bytes : program_like);
    const auto program = parse_program(text);
    if (program) {
      ++accepted;
    } else {
      ASSERT_GE(program.error().line, 1U);
      ASSERT_LE(program.error().line, static_cast<std::uint32_t>(std::ranges::count(text, '\n')) + 1);
    }
  }
  EXPECT_GT(accepted, 0U);
}

}  // namespace
}  // namespace kernel_mocks
