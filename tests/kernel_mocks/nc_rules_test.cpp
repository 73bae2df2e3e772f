// Which words, blocks and sequences of blocks the control takes. The first tests are the checks that
// LinuxCNC's interpreter was observed to make (kernel_mocks/README.md).
#include "kernel_mocks/nc_rules.hpp"

#include <gtest/gtest.h>

#include "tests/kernel_mocks/refusal.hpp"

namespace kernel_mocks {
namespace {

const std::string one_m_group = ": another M code of the same group stands in the block";
const std::string one_g_group = ": another G code of the same modal group stands in the block";
const std::string repeated = ": this letter stands in the block twice";
const std::string bad_m = ": an M code is a whole number from 0 to 199";
const std::string no_feed = ": G1, G2 and G3 need a feed greater than zero (with G93 in every block)";
const std::string no_user = ": no G code of the block and no modal motion uses this word";
const std::string no_centre = ": G2 and G3 need a centre (I, J, K) or a radius (R), not both";
const std::string no_motion = ": axis words without a motion: none of G0 to G3 is in force";
const std::string unknown_g = ": this control does not have this G code";

TEST(NcRules, two_m_codes_of_one_group_are_refused) {
  EXPECT_EQ(refusal_of_block("M3 M4"), "line 2, word 'M4'" + one_m_group);
  EXPECT_EQ(refusal_of_block("M8 M9"), "line 2, word 'M9'" + one_m_group);
  EXPECT_EQ(refusal_of_block("M7 M8"), "line 2, word 'M8'" + one_m_group);
  EXPECT_EQ(refusal_of_block("M0 M30"), "line 2, word 'M30'" + one_m_group);
  EXPECT_EQ(refusal_of_block("M1 M2"), "line 2, word 'M2'" + one_m_group);
}

TEST(NcRules, m13_counts_as_spindle_and_as_coolant) {
  EXPECT_EQ(refusal_of_block("M13 M9"), "line 2, word 'M9'" + one_m_group);
  EXPECT_EQ(refusal_of_block("M5 M14"), "line 2, word 'M14'" + one_m_group);
}

TEST(NcRules, the_same_m_code_twice_is_refused) {
  EXPECT_EQ(refusal_of_block("M100 M100"), "line 2, word 'M100'" + one_m_group);
}

TEST(NcRules, m_codes_of_different_groups_may_stand_together) {
  EXPECT_EQ(refusal_of_block("M3 M8"), "");
  EXPECT_EQ(refusal_of_block("M05 M09"), "");
}

TEST(NcRules, four_m_codes_are_taken_and_five_are_not) {
  static_assert(m_codes_per_block_max == 4);
  EXPECT_EQ(refusal_of_block("M100 M101 M102 M103"), "");
  EXPECT_EQ(refusal_of_block("M100 M101 M102 M103 M104"),
            "line 2, word 'M104': a block has at most 4 M codes");
}

TEST(NcRules, a_repeated_word_is_refused) {
  EXPECT_EQ(refusal_of_block("G0 X1 X2"), "line 2, word 'X2'" + repeated);
  EXPECT_EQ(refusal_of_block("T1 M6 T2"), "line 2, word 'T2'" + repeated);
  EXPECT_EQ(refusal_of_block("N1 N2"), "line 2, word 'N2'" + repeated);
  EXPECT_EQ(refusal_of_block(":1 N2"), "line 2, word 'N2'" + repeated);
}

TEST(NcRules, a_negative_s_is_refused) {
  EXPECT_EQ(refusal_of_block("S-100"), "line 2, word 'S-100': the spindle speed is not negative");
}

TEST(NcRules, a_negative_f_is_refused) {
  EXPECT_EQ(refusal_of_block("F-1"), "line 2, word 'F-1': the feed is not negative");
}

TEST(NcRules, a_negative_or_broken_n_is_refused) {
  const std::string reason = ": a block number is a whole number, not negative";
  EXPECT_EQ(refusal_of_block("N-10 M3"), "line 2, word 'N-10'" + reason);
  EXPECT_EQ(refusal_of_block("N1.5 M3"), "line 2, word 'N1.5'" + reason);
}

TEST(NcRules, m_199_is_taken_and_m_200_is_not) {
  static_assert(m_code_max == 199);
  EXPECT_EQ(refusal_of_block("M199"), "");
  EXPECT_EQ(refusal_of_block("M200"), "line 2, word 'M200'" + bad_m);
  EXPECT_EQ(refusal_of_block("M999999999"), "line 2, word 'M999999999'" + bad_m);
}

TEST(NcRules, an_m_with_a_fraction_or_a_sign_is_refused) {
  EXPECT_EQ(refusal_of_block("M3.5"), "line 2, word 'M3.5'" + bad_m);
  EXPECT_EQ(refusal_of_block("M-3"), "line 2, word 'M-3'" + bad_m);
}

TEST(NcRules, g1_with_feed_zero_is_refused) {
  EXPECT_EQ(refusal_of_block("G1 X1 F0"), "line 2, word 'G1'" + no_feed);
  EXPECT_EQ(refusal("F0\nG1 X1\nM2"), "line 2, word 'G1'" + no_feed);
}

TEST(NcRules, n_with_six_digits_is_taken) { EXPECT_EQ(refusal_of_block("N123456 M3"), ""); }

TEST(NcRules, a_tool_number_is_whole_and_not_negative) {
  const std::string reason = ": a tool number is a whole number, not negative";
  EXPECT_EQ(refusal_of_block("T-1"), "line 2, word 'T-1'" + reason);
  EXPECT_EQ(refusal_of_block("T1.5"), "line 2, word 'T1.5'" + reason);
}

TEST(NcRules, an_offset_number_is_whole_and_not_negative) {
  const std::string reason = ": an offset number is a whole number, not negative";
  EXPECT_EQ(refusal_of_block("G43 H1.5"), "line 2, word 'H1.5'" + reason);
  EXPECT_EQ(refusal_of_block("G41 D-1"), "line 2, word 'D-1'" + reason);
}

TEST(NcRules, the_block_number_comes_first) {
  EXPECT_EQ(refusal_of_block("M3 N10"),
            "line 2, word 'N10': the block number is the first word of its block");
}

TEST(NcRules, letters_that_no_function_uses_are_refused) {
  const std::string reason = ": no function of this control uses this letter";
  EXPECT_EQ(refusal_of_block("G0 X1.5E3"), "line 2, word 'E3'" + reason);
  EXPECT_EQ(refusal_of_block("G0 L2"), "line 2, word 'L2'" + reason);
}

TEST(NcRules, subprogram_calls_are_refused) {
  EXPECT_EQ(refusal_of_block("M98 P100"), "line 2, word 'M98': subprograms are not supported");
}

TEST(NcRules, unknown_g_codes_are_refused) {
  for (const std::string word : {"G5", "G10", "G33", "G38.2", "G70", "G1.5", "G-1", "G100", "G1.25"}) {
    EXPECT_EQ(refusal_of_block(word), "line 2, word '" + word + "'" + unknown_g);
  }
}

TEST(NcRules, canned_cycles_are_refused) {
  for (const std::string word : {"G73", "G74", "G76", "G81", "G84.2", "G88.1", "G89"}) {
    EXPECT_EQ(refusal_of_block(word), "line 2, word '" + word + "': canned cycles are not supported");
  }
}

TEST(NcRules, constant_surface_speed_is_refused_because_s_would_mean_something_else) {
  EXPECT_EQ(refusal_of_block("G96 S200"),
            "line 2, word 'G96': constant surface speed is not supported: the PLC would take S for "
            "revolutions per minute");
}

TEST(NcRules, two_g_codes_of_one_modal_group_are_refused) {
  EXPECT_EQ(refusal_of_block("G0 G1"), "line 2, word 'G1'" + one_g_group);
  EXPECT_EQ(refusal_of_block("G17 G18"), "line 2, word 'G18'" + one_g_group);
  EXPECT_EQ(refusal_of_block("G4 P1 G92"), "line 2, word 'G92'" + one_g_group);
  EXPECT_EQ(refusal_of_block("G54 G59.3"), "line 2, word 'G59.3'" + one_g_group);
}

TEST(NcRules, g_codes_of_different_groups_may_stand_together) {
  EXPECT_EQ(refusal_of_block("G17 G20 G40 G49 G54 G80 G90 G94 G64 P0.1"), "");
}

TEST(NcRules, axis_words_need_a_motion_in_force) {
  EXPECT_EQ(refusal_of_block("X1"), "line 2, word 'X1'" + no_motion);
  EXPECT_EQ(refusal("G0 X1\nG80\nX2\nM2"), "line 3, word 'X2'" + no_motion);
  EXPECT_EQ(refusal("G0 X1\nX2\nM2"), "");
}

TEST(NcRules, a_motion_stays_in_force_until_another_replaces_it) {
  EXPECT_EQ(refusal("F100\nG1 X1\nY2\nG0 Z1\nX0\nM2"), "");
}

TEST(NcRules, a_modal_motion_at_feed_needs_a_feed_too) {
  EXPECT_EQ(refusal("G1\nX1\nM2"), "line 2, word 'X1'" + no_feed);
}

TEST(NcRules, inverse_time_needs_a_feed_in_every_block) {
  EXPECT_EQ(refusal("G93 G1 X1 F2\nX2 F2\nM2"), "");
  EXPECT_EQ(refusal("G93 G1 X1 F2\nX2\nM2"), "line 2, word 'X2'" + no_feed);
}

TEST(NcRules, a_feed_of_another_feed_mode_does_not_count) {
  EXPECT_EQ(refusal("F100\nG95 G1 X1\nM2"), "line 2, word 'G1'" + no_feed);
  EXPECT_EQ(refusal("F100\nG94 G1 X1\nM2"), "");
  EXPECT_EQ(refusal("F100\nG93\nG1 X1\nM2"), "line 3, word 'G1'" + no_feed);
  EXPECT_EQ(refusal("G93 G1 X1 F2\nG94 X2\nM2"), "line 2, word 'X2'" + no_feed);
}

TEST(NcRules, an_arc_needs_a_centre_or_a_radius_and_not_both) {
  EXPECT_EQ(refusal_of_block("G2 X1 Y1 F10"), "line 2, word 'G2'" + no_centre);
  EXPECT_EQ(refusal_of_block("G2 X1 Y1 I1 R1 F10"), "line 2, word 'G2'" + no_centre);
  EXPECT_EQ(refusal_of_block("G2 X1 Y1 I1 F10"), "");
  EXPECT_EQ(refusal_of_block("G3 X1 Y1 R1 F10"), "");
}

TEST(NcRules, a_full_circle_needs_no_axis_words) { EXPECT_EQ(refusal_of_block("G2 I5 F10"), ""); }

TEST(NcRules, words_that_nothing_uses_are_refused) {
  EXPECT_EQ(refusal_of_block("G0 X1 I1"), "line 2, word 'I1'" + no_user);
  EXPECT_EQ(refusal_of_block("G1 X1 R1 F1"), "line 2, word 'R1'" + no_user);
  EXPECT_EQ(refusal_of_block("M190 P1"), "line 2, word 'P1'" + no_user);
  EXPECT_EQ(refusal_of_block("M3 Q1"), "line 2, word 'Q1'" + no_user);
  EXPECT_EQ(refusal_of_block("G0 X1 D1"), "line 2, word 'D1'" + no_user);
  EXPECT_EQ(refusal_of_block("G0 Z1 H1"), "line 2, word 'H1'" + no_user);
}

TEST(NcRules, a_dwell_and_the_end_of_an_offset_are_no_block_to_move_in) {
  const std::string reason = ": G4 and G92.1 to G92.3 stand in a block that moves nothing";
  EXPECT_EQ(refusal_of_block("G0 G4 P1 X5"), "line 2, word 'G4'" + reason);
  EXPECT_EQ(refusal_of_block("G1 F100 X1\nG4 P1 X5"), "line 3, word 'G4'" + reason);
  EXPECT_EQ(refusal_of_block("G1 F100 X1\nG92.1 X5"), "line 3, word 'G92.1'" + reason);
  EXPECT_EQ(refusal_of_block("G2 F100 I1 G92.3"), "line 2, word 'G92.3'" + reason);
  EXPECT_EQ(refusal_of_block("G1 F100 G4 P1"), "");
  EXPECT_EQ(refusal_of_block("G0 X5\nG92.2"), "");
}

TEST(NcRules, a_dwell_needs_its_time) {
  const std::string reason = ": G4 needs its time in seconds in a P word, not negative";
  EXPECT_EQ(refusal_of_block("G4"), "line 2, word 'G4'" + reason);
  EXPECT_EQ(refusal_of_block("G4 P-1"), "line 2, word 'G4'" + reason);
  EXPECT_EQ(refusal_of_block("G4 P0.5"), "");
}

TEST(NcRules, machine_coordinates_need_a_straight_motion) {
  EXPECT_EQ(refusal_of_block("G53 Z0"), "line 2, word 'Z0'" + no_motion);
  EXPECT_EQ(refusal_of_block("G53"), "line 2, word 'G53': G53 needs G0 or G1");
  EXPECT_EQ(refusal_of_block("G53 G0 Z0"), "");
}

TEST(NcRules, the_axis_words_of_a_block_belong_to_one_g_code) {
  EXPECT_EQ(refusal_of_block("G0 G28 X0"),
            "line 2, word 'G0': two G codes of the block claim its axis words");
  EXPECT_EQ(refusal_of_block("G28 X0"), "");
}

}  // namespace
}  // namespace kernel_mocks
