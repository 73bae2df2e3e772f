#include "kernel_mocks/decimal.hpp"

#include <gtest/gtest.h>

namespace kernel_mocks {
namespace {

std::string read(std::string_view text) {
  const auto value = Decimal::parse(text);
  return value ? to_string(*value) : value.error() == DecimalError::not_a_number ? "no number" : "too long";
}

TEST(Decimal, reads_whole_numbers_fractions_and_signs) {
  EXPECT_EQ(read("40"), "40");
  EXPECT_EQ(read("3.5"), "3.5");
  EXPECT_EQ(read("+2.1"), "2.1");
  EXPECT_EQ(read("-0.25"), "-0.25");
  EXPECT_EQ(read(".1"), "0.1");
  EXPECT_EQ(read("10."), "10");
  EXPECT_EQ(read("-.000000001"), "-0.000000001");
}

TEST(Decimal, is_whole_only_when_the_fraction_is_zero) {
  EXPECT_TRUE(Decimal::parse("3.000")->is_whole());
  EXPECT_FALSE(Decimal::parse("3.000000001")->is_whole());
}

TEST(Decimal, refuses_what_is_not_a_number) {
  for (const std::string_view text : {"", "+", "-", ".", "-.", "1.2.3", "1-2", "1+", "--1", "1e5", " 1"}) {
    EXPECT_EQ(read(text), "no number") << text;
  }
}

TEST(Decimal, takes_nine_digits_before_and_after_the_point_and_not_ten) {
  EXPECT_EQ(read("999999999.999999999"), "999999999.999999999");
  EXPECT_EQ(read("-999999999.999999999"), "-999999999.999999999");
  EXPECT_EQ(read("1000000000"), "too long");
  EXPECT_EQ(read("0.0000000001"), "too long");
}

TEST(Decimal, does_not_count_leading_and_trailing_zeros) {
  EXPECT_EQ(read("00000000000000000012"), "12");
  EXPECT_EQ(read("0.50000000000000000000"), "0.5");
}

}  // namespace
}  // namespace kernel_mocks
