// How long the motion of a block lasts, and what is refused.
#include "kernel_mocks/motion.hpp"

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

}  // namespace
}  // namespace kernel_mocks
