// The table of functions that cnc-kernel prints after a run.
#include "kernel_mocks/function_table.hpp"

#include <gtest/gtest.h>

#include "kernel_mocks/axis_limit_text.hpp"

namespace kernel_mocks {
namespace {

using namespace std::chrono_literals;

constexpr FunctionTable::TimePoint start{100s};

Block block(std::uint32_t number) {
  Block made;
  made.number = number;
  return made;
}

FunctionRequest m(std::uint16_t code) { return {.m = code, .s = {}, .t = {}}; }

FunctionTable table_of_one(const LogicFailure& failure) {
  FunctionTable table;
  table.program_begun(start);
  table.given(block(60), m(8), start + 6800ms);
  table.not_acknowledged(failure, start + 9820ms);
  return table;
}

TEST(FunctionTable, shows_begin_and_fin_since_the_program_start_and_the_duration) {
  FunctionTable table;
  table.program_begun(start);
  table.given(block(30), {.m = std::uint16_t{6}, .s = {}, .t = std::uint16_t{1}}, start + 60ms);
  table.acknowledged(4250ms);
  EXPECT_EQ(table.to_text(),
            "block      function                begin s     FIN s  duration s  result\n"
            "N30        M6 T1                      0.06      4.31        4.25  done\n"
            "motion: none\n");
}

TEST(FunctionTable, a_function_that_ended_in_an_alarm_has_no_fin_but_the_number_of_the_alarm) {
  EXPECT_EQ(table_of_one({.fault = LogicFault::alarm, .alarm_number = 6}).to_text(),
            "block      function                begin s     FIN s  duration s  result\n"
            "N60        M8                         6.80         -        3.02  alarm 6\n"
            "motion: none\n");
}

TEST(FunctionTable, other_ends_have_their_names) {
  const auto result = [](LogicFault fault) {
    const std::string text = table_of_one({.fault = fault}).to_text();
    const std::size_t begin = text.find("3.02  ") + 6;
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  EXPECT_EQ(result(LogicFault::operator_reset), "abandoned");
  EXPECT_EQ(result(LogicFault::interrupted), "abandoned");
  EXPECT_EQ(result(LogicFault::emergency_stop), "emergency stop");
  EXPECT_EQ(result(LogicFault::fin_missing), "no FIN");
  EXPECT_EQ(result(LogicFault::fin_stuck), "FIN stays on");
  EXPECT_EQ(result(LogicFault::link_lost), "link lost");
}

TEST(FunctionTable, a_line_sums_up_the_motion_by_its_kinds) {
  FunctionTable table;
  table.moved(MotionKind::feed, 1s, true);
  table.moved(MotionKind::rapid, 250ms, true);
  table.moved(MotionKind::feed, 500ms, false);
  const std::string text = table.to_text();
  EXPECT_EQ(text.substr(text.find('\n') + 1),
            "motion: 1 rapid 0.25 s, 2 feed moves 1.50 s; the last one was cut short\n");
}

TEST(AxisLimitText, is_an_axis_and_two_positions) {
  const auto limit = parse_axis_limit("Z=-300.5:10");
  ASSERT_TRUE(limit.has_value());
  EXPECT_EQ(limit->axis, z_axis);
  EXPECT_EQ(limit->travel.min, -300.5);
  EXPECT_EQ(limit->travel.max, 10);
}

TEST(AxisLimitText, anything_else_is_refused) {
  for (const char* const text : {"", "X", "X=", "X=1", "X=1:", "X=:1", "Q=0:1", "X=2:1", "X=1:2", "X=-2:-1",
                                 "X=0:1x", "X=nan:1", "X:0=1", "=0:1"}) {
    EXPECT_FALSE(parse_axis_limit(text).has_value()) << text;
  }
}

}  // namespace
}  // namespace kernel_mocks
