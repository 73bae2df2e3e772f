// Literals: what each is worth, and what is none.
#include "emulator_models/soft_plc/il_literal.hpp"

#include <gtest/gtest.h>

namespace emulator_models::soft_plc {
namespace {

constexpr ElementaryType int_type = ElementaryType::int_;

/// The bits of the literal as a value of the type, as a signed number; or "no".
std::string value(std::string_view text, ElementaryType type) {
  const auto literal = parse_literal(text);
  if (!literal) return "no";
  const auto bits = value_as(*literal, type);
  return bits ? std::to_string(static_cast<std::int64_t>(*bits)) : "no";
}

std::string milliseconds(std::string_view text) {
  const auto literal = parse_literal(text);
  return literal ? std::to_string(static_cast<double>(literal->duration_ns) / 1e6) : "no";
}

TEST(IlLiteral, integers_have_bases_signs_and_single_underscores) {
  EXPECT_EQ(value("5", int_type), "5");
  EXPECT_EQ(value("-5", int_type), "-5");
  EXPECT_EQ(value("16#FF", int_type), "255");
  EXPECT_EQ(value("16#ff", int_type), "255");
  EXPECT_EQ(value("8#17", int_type), "15");
  EXPECT_EQ(value("2#1010_0101", int_type), "165");
  EXPECT_EQ(value("1_000", int_type), "1000");
  for (const char* const wrong : {"1__0", "_1", "1_", "10#5", "2#2", "8#8", "16#", "16#G", "1E3"})
    EXPECT_EQ(value(wrong, int_type), "no") << wrong;
}

TEST(IlLiteral, integers_fit_to_the_limits_of_a_type_and_not_one_further) {
  EXPECT_EQ(value("32767", int_type), "32767");
  EXPECT_EQ(value("32768", int_type), "no");
  EXPECT_EQ(value("-32768", int_type), "-32768");
  EXPECT_EQ(value("-32769", int_type), "no");
  EXPECT_EQ(value("255", ElementaryType::usint), "255");
  EXPECT_EQ(value("256", ElementaryType::usint), "no");
  EXPECT_EQ(value("-1", ElementaryType::uint), "no");
  EXPECT_EQ(value("-9223372036854775808", ElementaryType::lint), "-9223372036854775808");
  EXPECT_EQ(value("9223372036854775808", ElementaryType::lint), "no");
  EXPECT_EQ(value("18446744073709551615", ElementaryType::ulint), "-1");  // all bits
  EXPECT_EQ(value("18446744073709551616", ElementaryType::ulint), "no");
}

TEST(IlLiteral, bool_is_true_false_one_or_zero) {
  constexpr ElementaryType boolean = ElementaryType::boolean;
  EXPECT_EQ(value("TRUE", boolean), "1");
  EXPECT_EQ(value("false", boolean), "0");
  EXPECT_EQ(value("1", boolean), "1");
  EXPECT_EQ(value("BOOL#1", boolean), "1");
  EXPECT_EQ(value("BOOL#TRUE", boolean), "1");
  EXPECT_EQ(value("2", boolean), "no");
  EXPECT_EQ(value("TRUE", int_type), "no");
}

TEST(IlLiteral, a_typed_one_has_its_type_only) {
  EXPECT_EQ(value("INT#5", int_type), "5");
  EXPECT_EQ(value("INT#-5", int_type), "-5");
  EXPECT_EQ(value("INT#5", ElementaryType::dint), "no");
  EXPECT_EQ(value("WORD#16#FFFF", ElementaryType::word), "65535");
  EXPECT_EQ(value("INT#16#FFFF", int_type), "no");
  EXPECT_EQ(value("FOO#5", int_type), "no");
}

TEST(IlLiteral, reals_have_a_point_with_digits_around_it) {
  const auto lreal = [](std::string_view text) {
    const auto literal = parse_literal(text);
    const auto bits = literal ? value_as(*literal, ElementaryType::lreal) : tl::unexpected(literal.error());
    return bits ? as_lreal(*bits) : -999.0;
  };
  EXPECT_EQ(lreal("1.5"), 1.5);
  EXPECT_EQ(lreal("-1.5E3"), -1500.0);
  EXPECT_EQ(lreal("2.5e-1"), 0.25);
  EXPECT_EQ(lreal("1_0.2_5"), 10.25);
  EXPECT_EQ(lreal("LREAL#5"), 5.0);
  for (const char* const wrong : {"5", "1.", "1.5E", "1.E3", "1.0E400", "1.2.3"})
    EXPECT_EQ(lreal(wrong), -999.0) << wrong;
  EXPECT_EQ(value("1.0E39", ElementaryType::real), "no");
  EXPECT_EQ(value("1.5", int_type), "no");
}

TEST(IlLiteral, durations_add_their_parts) {
  EXPECT_EQ(milliseconds("T#1h2m3s4ms"), "3723004.000000");
  EXPECT_EQ(milliseconds("t#1.5s"), "1500.000000");
  EXPECT_EQ(milliseconds("TIME#100ms"), "100.000000");
  EXPECT_EQ(milliseconds("T#-5s"), "-5000.000000");
  EXPECT_EQ(milliseconds("T#1d_2h"), "93600000.000000");
  EXPECT_EQ(milliseconds("T#0.25ms"), "0.250000");
  EXPECT_EQ(value("T#1s", int_type), "no");
  EXPECT_EQ(value("5", ElementaryType::time), "no");
}

TEST(IlLiteral, only_the_last_part_of_a_duration_has_a_fraction_and_only_the_first_exceeds_its_unit) {
  EXPECT_EQ(milliseconds("T#90m"), "5400000.000000");
  EXPECT_EQ(milliseconds("T#25h59m"), "93540000.000000");
  for (const char* const wrong : {"T#1h60m", "T#1.5h3m", "T#1s2h", "T#1s1s", "T#", "T#5", "T#1.s", "T#s",
                                  "T#1x", "T#1us", "T#106752d", "T#99999999999999999999d", "T#1s_"})
    EXPECT_EQ(milliseconds(wrong), "no") << wrong;
}

}  // namespace
}  // namespace emulator_models::soft_plc
