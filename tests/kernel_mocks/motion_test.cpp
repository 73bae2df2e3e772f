// How long the motion of a block lasts, and what is refused.
#include "kernel_mocks/motion.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "kernel_mocks/nc_parser.hpp"

namespace kernel_mocks {
namespace {

using namespace std::chrono_literals;

/// Duration of the last motion of a program.
std::chrono::nanoseconds last_duration(const std::string& text) {
  MotionPlanner planner{{}};
  std::chrono::nanoseconds duration{0};
  const auto program = parse_program(text + "\nM30");
  for (const Block& block : program->blocks) {
    const auto planned = planner.plan(block);
    EXPECT_TRUE(planned.has_value()) << text;
    if (planned && *planned) duration = (*planned)->duration;
  }
  return duration;
}

TEST(Motion, g1_lasts_length_by_feed) { EXPECT_EQ(last_duration("G1 X30 Y40 F600"), 5s); }
TEST(Motion, g0_lasts_as_long_as_its_slowest_axis) { EXPECT_EQ(last_duration("G0 X100 Y50"), 600ms); }
TEST(Motion, g91_moves_by_its_words) { EXPECT_EQ(last_duration("G91 G1 X10 F600\nX10"), 1s); }
TEST(Motion, g20_is_in_inches) { EXPECT_EQ(last_duration("G20 G1 X1 F60"), 1s); }
TEST(Motion, g93_is_the_inverse_of_its_minutes) { EXPECT_EQ(last_duration("G93 G1 X1 F2"), 30s); }
TEST(Motion, g4_dwells_in_seconds) { EXPECT_EQ(last_duration("G4 P0.5"), 500ms); }
TEST(Motion, a_half_circle_is_the_same_by_centre_and_by_radius) {
  EXPECT_EQ(last_duration("G2 X20 I10 F600"), last_duration("G2 X20 R10 F600"));
  EXPECT_NEAR(static_cast<double>(last_duration("G2 X20 I10 F600").count()), 3.14159265e9, 100);
}

/// The refusal of a program's motion, as the user reads it; "" when there is none.
std::string refusal_of_motion(const std::string& text, const AxisOptions& axes = {}) {
  const auto checked = check_motion(parse_program(text + "\nM30").value(), axes);
  return checked ? "" : to_string(checked.error());
}

AxisOptions with_travel(std::size_t axis, double min, double max) {
  AxisOptions axes;
  axes.travel[axis] = {{min, max}};
  return axes;
}

TEST(Motion, g90_moves_to_its_words) { EXPECT_EQ(last_duration("G1 X10 F600\nG90 X30"), 2s); }
TEST(Motion, g20_and_g21_hold_for_feed_too) {
  EXPECT_EQ(last_duration("G20 G1 X1 F60\nG21 X50.8 F60"), 25400ms);
}
TEST(Motion, rotary_axes_are_in_degrees_whatever_the_units) {
  EXPECT_EQ(last_duration("G20 G0 A100"), last_duration("G21 G0 A100"));
}
TEST(Motion, g94_is_by_minute) { EXPECT_EQ(last_duration("G94 G1 X10 F60"), 10s); }
TEST(Motion, g95_is_by_revolution) { EXPECT_EQ(last_duration("G95 S600 M3 G1 X10 F0.1"), 10s); }
TEST(Motion, g95_without_a_speed_is_refused) {
  EXPECT_EQ(refusal_of_motion("G95 G1 X10 F0.1").substr(0, 7), "line 1:");
}
TEST(Motion, g93_holds_for_each_block_by_its_own_word) {
  EXPECT_EQ(last_duration("G93 G1 X1 F2\nX5 F60"), 1s);
}
TEST(Motion, no_feed_is_faster_than_a_rapid) { EXPECT_EQ(last_duration("G1 X1000 F90000"), 6s); }
TEST(Motion, g92_shifts_the_zero_and_moves_nothing) {
  EXPECT_EQ(last_duration("G1 X10 F600\nG92 X0\nX10"), 1s) << "from machine 10 to 20";
  EXPECT_EQ(last_duration("G1 X10 F600\nG92 X0\nG92.1\nX30"), 2s) << "from 10 to 30, the offset is gone";
  EXPECT_EQ(last_duration("G1 X10 F600\nG92 X0\nG92.2\nG92.3\nX10"), 1s) << "G92.3 brings it back";
  EXPECT_EQ(last_duration("G1 X10 F600\nG92 X0\nG92.1\nG92.3\nX30"), 2s) << "G92.1 has forgotten it";
}
TEST(Motion, g53_moves_in_machine_coordinates) {
  EXPECT_EQ(last_duration("G1 X10 F600\nG92 X0\nG53 X20"), 1s);
}
TEST(Motion, g28_goes_by_way_of_its_point_to_zero_at_rapid_rate) {
  EXPECT_EQ(last_duration("G0 X100\nG28 X150"), 1200ms) << "50 mm on, 150 mm back";
}
TEST(Motion, a_percentage_scales_the_time) {
  MotionPlanner planner{{.time_percent = 50}};
  EXPECT_EQ((*planner.plan(parse_program("G1 X10 F600\nM30")->blocks[0]))->duration, 500ms);
}
TEST(Motion, an_axis_moves_up_to_its_limit_and_not_beyond) {
  const AxisOptions axes = with_travel(0, -10, 100);
  EXPECT_EQ(refusal_of_motion("G0 X100\nX-10", axes), "");
  EXPECT_EQ(refusal_of_motion("G0 X100\nX100.001", axes),
            "line 2, word 'X100.001': the axis would leave its travel");
  EXPECT_EQ(refusal_of_motion("G0 X-10.001", axes),
            "line 1, word 'X-10.001': the axis would leave its travel");
}
TEST(Motion, a_limit_counts_in_machine_coordinates) {
  const AxisOptions axes = with_travel(0, 0, 100);
  EXPECT_NE(refusal_of_motion("G0 X60\nG92 X0\nG0 X50", axes), "");
  EXPECT_NE(refusal_of_motion("G0 X60\nG91 X50", axes), "");
  EXPECT_NE(refusal_of_motion("G28 X101", axes), "") << "the point between";
}
TEST(Motion, increments_that_sum_up_to_the_limit_reach_it) {
  std::string text = "G91 G0 X0.1";
  for (unsigned step = 1; step < 10; ++step) text += "\nX0.1";
  EXPECT_EQ(refusal_of_motion(text, with_travel(0, 0, 1)), "");
}
TEST(Motion, an_arc_that_crosses_a_limit_between_its_ends_is_refused) {
  // Half a circle from X0 Y0 to X20 Y0: up to Y10 (G2), down to Y-10 (G3).
  EXPECT_EQ(refusal_of_motion("G2 X20 I10 F600", with_travel(1, -1, 10)), "");
  EXPECT_EQ(refusal_of_motion("G2 X20 I10 F600", with_travel(1, -1, 9.9)),
            "line 1: the axis would leave its travel");
  EXPECT_EQ(refusal_of_motion("G3 X20 I10 F600", with_travel(1, -10, 1)), "");
  EXPECT_NE(refusal_of_motion("G3 X20 I10 F600", with_travel(1, -9.9, 1)), "");
}
TEST(Motion, so_is_a_full_circle_on_each_side) {
  EXPECT_EQ(refusal_of_motion("G2 X0 I10 F600", with_travel(0, 0, 20)), "");
  EXPECT_NE(refusal_of_motion("G2 X0 I10 F600", with_travel(0, 0, 19.9)), "");
  EXPECT_NE(refusal_of_motion("G2 X0 J-10 F600", with_travel(0, -9.9, 10)), "");
  EXPECT_NE(refusal_of_motion("G2 X0 J-10 F600", with_travel(1, -19.9, 0)), "");
}
TEST(Motion, the_sign_of_the_radius_chooses_the_arc_and_with_it_what_it_crosses) {
  // A quarter from X0 Y0 to X10 Y10 clockwise by R10 has its centre at X10 Y0; by R-10, three quarters, at X0 Y10.
  EXPECT_EQ(refusal_of_motion("G2 X10 Y10 R10 F600", with_travel(0, 0, 10)), "");
  EXPECT_EQ(refusal_of_motion("G2 X10 Y10 R-10 F600", with_travel(0, -10, 10)), "");
  EXPECT_NE(refusal_of_motion("G2 X10 Y10 R-10 F600", with_travel(0, -9.9, 10)), "");
  EXPECT_NE(refusal_of_motion("G2 X10 Y10 R-10 F600", with_travel(1, 0, 19.9)), "");
  EXPECT_NE(refusal_of_motion("G3 X10 Y10 R-10 F600", with_travel(0, 0, 19.9)), "");
  EXPECT_NE(refusal_of_motion("G3 X10 Y10 R-10 F600", with_travel(1, -9.9, 10)), "");
}
TEST(Motion, the_other_planes_have_their_own_axes) {
  EXPECT_NE(refusal_of_motion("G18 G2 Z20 K10 F600", with_travel(0, -1, 9.9)), "");
  EXPECT_NE(refusal_of_motion("G19 G2 Y20 J10 F600", with_travel(2, -1, 9.9)), "");
}
TEST(Motion, a_quarter_and_its_rest_make_a_circle) {
  const auto whole = last_duration("G2 X0 I10 F600");
  EXPECT_NEAR(
      static_cast<double>(
          (last_duration("G2 X10 Y10 R10 F600") + last_duration("G2 X10 Y10 R-10 F600") - whole).count()),
      0, 100);
}
TEST(Motion, p_adds_turns) {
  EXPECT_NEAR(static_cast<double>(last_duration("G2 X0 I10 P3 F600").count()),
              3 * static_cast<double>(last_duration("G2 X0 I10 F600").count()), 100);
}
TEST(Motion, a_helix_is_as_long_as_its_thread) {
  EXPECT_NEAR(static_cast<double>(last_duration("G2 X0 Z30 I10 F600").count()),
              std::hypot(2 * std::numbers::pi * 10, 30) / 10 * 1e9, 100);
}
TEST(Motion, g90_1_gives_the_centre_as_a_position) {
  EXPECT_EQ(last_duration("G0 X10\nG90.1 G2 X30 I20 J0 F600"), last_duration("G0 X10\nG2 X30 I10 F600"));
}
TEST(Motion, an_arc_whose_end_is_off_its_circle_is_refused) {
  EXPECT_EQ(refusal_of_motion("G2 X20 I9.99 F600"), "") << "programs are rounded";
  EXPECT_NE(refusal_of_motion("G2 X20 I9.9 F600"), "");
}
TEST(Motion, an_arc_without_a_circle_is_refused) {
  EXPECT_NE(refusal_of_motion("G2 X20 R9.9 F600"), "") << "the radius is less than half the way";
  EXPECT_NE(refusal_of_motion("G2 X0 R10 F600"), "") << "no way, any circle";
  EXPECT_NE(refusal_of_motion("G2 X20 I0 F600"), "") << "the centre is the start";
}
TEST(Motion, a_motion_of_more_than_a_day_is_refused) {
  EXPECT_EQ(refusal_of_motion("G4 P86400"), "");
  EXPECT_NE(refusal_of_motion("G4 P86401"), "");
}

}  // namespace
}  // namespace kernel_mocks
