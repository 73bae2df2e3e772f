// How characters become words: ISO-7bit text, one line at a time.
#include <gtest/gtest.h>

#include "kernel_mocks/nc_lexer.hpp"
#include "tests/kernel_mocks/refusal.hpp"

namespace kernel_mocks {
namespace {

/// The words of a line, in the shortest writing, with a "/" in front of an optional block.
std::string words_of(std::string_view line) {
  const auto lexed = lex_line(line, 1);
  if (!lexed) return to_string(lexed.error());
  std::string text = lexed->optional_skip ? "/" : "";
  for (const LexedWord& word : lexed->words) {
    if (!text.empty() && text != "/") text += ' ';
    text += word.letter + to_string(word.value);
  }
  return text;
}

TEST(NcWords, are_a_letter_and_a_number) { EXPECT_EQ(words_of("N10 G01 X12.50 F200"), "N10 G1 X12.5 F200"); }

TEST(NcWords, need_no_blanks_between_them) { EXPECT_EQ(words_of("g1x0y-.5z+2"), "G1 X0 Y-0.5 Z2"); }

TEST(NcWords, may_be_in_lower_case) { EXPECT_EQ(words_of("n10 m3 s500"), "N10 M3 S500"); }

TEST(NcWords, may_have_blanks_inside_a_number) { EXPECT_EQ(words_of("X 1 0 . 5\tM\t3"), "X10.5 M3"); }

TEST(NcWords, ignore_carriage_returns) { EXPECT_EQ(words_of("G0 X1\r"), "G0 X1"); }

TEST(NcWords, keep_the_text_as_written_for_messages) {
  EXPECT_EQ(lex_line("m 0 3 . 5", 1)->words.front().text, "m03.5");
}

TEST(NcWords, leave_out_comments_in_parentheses) {
  EXPECT_EQ(words_of("(a) G1 (75 345) X1 (M30)"), "G1 X1");
  EXPECT_EQ(words_of("N0060 (MSG,Load tool #1)"), "N60");
}

TEST(NcWords, leave_out_everything_after_a_semicolon) { EXPECT_EQ(words_of("G1 X1 ; M30 ( #"), "G1 X1"); }

TEST(NcWords, a_semicolon_inside_parentheses_is_comment_text) { EXPECT_EQ(words_of("(a;b) M3"), "M3"); }

TEST(NcWords, a_number_ends_at_a_comment) {
  EXPECT_EQ(words_of("X1(one)0"), "line 1, word '0': a word is a letter and a number");
}

TEST(NcWords, a_slash_in_front_marks_an_optional_block) { EXPECT_EQ(words_of(" /N10 M8"), "/N10 M8"); }

TEST(NcWords, a_slash_elsewhere_is_refused) {
  EXPECT_EQ(words_of("N10 /M8"),
            "line 1, word '/': the sign / of the optional block skip stands at the start of a block only");
}

TEST(NcWords, a_letter_alone_is_refused) {
  EXPECT_EQ(words_of("G1 X F5"), "line 1, word 'X': a word is a letter and a number");
}

TEST(NcWords, a_number_alone_is_refused) {
  EXPECT_EQ(words_of("10 G1"), "line 1, word '1': a word is a letter and a number");
}

TEST(NcWords, two_decimal_points_are_refused) {
  EXPECT_EQ(words_of("X1.2.3"),
            "line 1, word 'X1.2.3': the number is a sign, digits and at most one decimal point");
}

TEST(NcWords, a_sign_inside_a_number_is_refused) {
  EXPECT_EQ(words_of("X1-2"),
            "line 1, word 'X1-2': the number is a sign, digits and at most one decimal point");
}

TEST(NcWords, an_open_comment_is_refused) {
  EXPECT_EQ(words_of("G1 (to the left"), "line 1, word '(': the comment is not closed by ) in its line");
}

TEST(NcWords, a_comment_in_a_comment_is_refused) {
  EXPECT_EQ(words_of("(a (b) c) M3"), "line 1, word '(': a comment cannot contain (");
}

TEST(NcWords, a_closing_parenthesis_alone_is_refused) {
  EXPECT_EQ(words_of("M3 )"), "line 1, word ')': a ) without its (");
}

TEST(NcWords, expressions_and_parameters_are_refused) {
  const std::string reason = ": expressions, parameters and assignments ([ ] # = < >) are not supported";
  EXPECT_EQ(words_of("T#<toolno>M6"), "line 1, word 'T#'" + reason);
  EXPECT_EQ(words_of("X[1+2]"), "line 1, word 'X['" + reason);
  EXPECT_EQ(words_of("#1 = 5"), "line 1, word '#'" + reason);
}

TEST(NcWords, o_words_are_refused_as_what_they_are) {
  const std::string reason =
      ": O words (subroutines, branches, loops) are not supported; a program number stands alone in the "
      "first "
      "block";
  EXPECT_EQ(words_of("O<probe> sub"), "line 1, word 'O'" + reason);
  EXPECT_EQ(words_of("o100 if [#1 GT 2]"), "line 1, word 'o100'" + reason);
  EXPECT_EQ(words_of("o101 endsub"), "line 1, word 'o101'" + reason);
}

TEST(NcWords, other_characters_are_refused_and_shown_in_hexadecimal_when_invisible) {
  const std::string reason = ": not a character of the ISO-7bit program code";
  EXPECT_EQ(words_of("G1 @5"), "line 1, word '@'" + reason);
  EXPECT_EQ(words_of(std::string_view{"\0", 1}), "line 1, word '\\x00'" + reason);
  EXPECT_EQ(words_of("\xD0\x9C"
                     "3"),
            "line 1, word '\\xD0'" + reason);
}

TEST(NcWords, any_character_may_stand_in_a_comment) { EXPECT_EQ(words_of("M3 (\xD1\x82\x01 #[%)"), "M3"); }

}  // namespace
}  // namespace kernel_mocks
