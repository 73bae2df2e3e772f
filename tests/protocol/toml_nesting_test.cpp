// What counts as nesting, and what only looks like it.
#include "protocol/toml_nesting.hpp"

#include <string>

#include <gtest/gtest.h>

namespace protocol {
namespace {

std::string times(std::size_t count, std::string_view what) {
  std::string text;
  for (; count > 0; --count) text += what;
  return text;
}

TEST(TomlNesting, brackets_nest_as_deep_as_the_bound_and_no_deeper) {
  EXPECT_EQ(too_deep_nesting("a = " + times(toml_nesting_max, "[")), std::nullopt);
  EXPECT_EQ(too_deep_nesting("\na = " + times(toml_nesting_max + 1, "[")), (TomlPlace{2, 13}));
  EXPECT_EQ(too_deep_nesting("a = " + times(toml_nesting_max + 1, "{ b = [ ")), (TomlPlace{1, 37}));
}

TEST(TomlNesting, brackets_that_are_closed_do_not_count) {
  EXPECT_EQ(too_deep_nesting(times(100, "[[cycle]]\nsends = { first_word = 0 }\n")), std::nullopt);
}

TEST(TomlNesting, each_part_of_a_dotted_key_is_a_table) {
  EXPECT_EQ(too_deep_nesting(times(toml_nesting_max - 1, "a.") + "a = 1"), std::nullopt);
  EXPECT_EQ(too_deep_nesting(times(toml_nesting_max, "a.") + "a = 1"), (TomlPlace{1, 16}));
  EXPECT_EQ(too_deep_nesting(std::string{"["}.append(times(toml_nesting_max, "a.")) + "a]"),
            (TomlPlace{1, 17}));
  EXPECT_EQ(too_deep_nesting(times(toml_nesting_max, "\"a\" . 'b.' . ") + "a = 1"), (TomlPlace{1, 51}));
}

TEST(TomlNesting, points_of_numbers_are_no_parts_of_a_key) {
  EXPECT_EQ(too_deep_nesting("a = [" + times(100, "1.5, ") + "]\n" + times(100, "b.c = 1.5\n")),
            std::nullopt);
}

TEST(TomlNesting, the_value_is_not_counted_with_its_key) {
  EXPECT_EQ(too_deep_nesting(times(toml_nesting_max - 1, "a.") + "a = 1.5"), std::nullopt);
}

TEST(TomlNesting, quotes_before_those_that_close_a_string_open_no_other) {
  for (const char* quoted : {"\"\"\"a\"\"\"\"", "'''a''''", "\"\"\"a\"\"\"\"\""})
    EXPECT_NE(too_deep_nesting(std::string{quoted} + times(toml_nesting_max + 1, "[")), std::nullopt)
        << quoted;
}

TEST(TomlNesting, strings_and_comments_do_not_nest) {
  const std::string deep = times(50, "[a.b.c.d.");
  for (const std::string& quoted :
       {"'" + deep + "'", "\"" + deep + "\\\"" + deep + "\"", "'''" + deep + "\n''" + deep + "'''''",
        "\"\"\"" + deep + "\n\\\"\"\"" + deep + "\"\"\"\"", "# " + deep, "\"\" # " + deep}) {
    EXPECT_EQ(too_deep_nesting(std::string{"a = "} + quoted + "\n"), std::nullopt) << quoted;
    EXPECT_NE(too_deep_nesting(std::string{"a = "} + quoted + "\nb = " + deep), std::nullopt) << quoted;
  }
}

TEST(TomlNesting, a_text_that_ends_anywhere_is_read_to_its_end) {
  for (const char* text : {"", "\"", "'", "\"\"\"", "'''a", "\"\\", "\"\"\"\\", "#", "]", "a = \"b\n]"})
    EXPECT_EQ(too_deep_nesting(text), std::nullopt) << text;
}

}  // namespace
}  // namespace protocol
