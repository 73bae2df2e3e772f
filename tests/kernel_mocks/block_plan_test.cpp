// Which functions of a block go to the PLC, when, and together with what.
#include "kernel_mocks/block_plan.hpp"

#include <gtest/gtest.h>

#include "kernel_mocks/nc_parser.hpp"

namespace kernel_mocks {
namespace {

tl::expected<BlockPlan, NcError> plan(const std::string& block) {
  const auto program = parse_program("%\nF100\n" + block + "\n%");
  EXPECT_TRUE(program.has_value()) << block;
  return plan_block(program->blocks.at(1));
}

/// The handshakes in their order, the motion as "motion", the program flow in words.
std::string told(const std::string& block) {
  const auto planned = plan(block);
  if (!planned) return to_string(planned.error());
  std::string text;
  const auto append = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  for (const auto& request : planned->begin) append(to_string(request));
  if (planned->has_motion) append("motion");
  for (const auto& request : planned->end) append(to_string(request));
  switch (planned->flow) {
    case ProgramFlow::none:
      break;
    case ProgramFlow::stop:
      append("stop");
      break;
    case ProgramFlow::optional_stop:
      append("optional stop");
      break;
    case ProgramFlow::end:
      append("end");
      break;
  }
  return text;
}

TEST(BlockPlan, spindle_and_coolant_go_on_before_the_motion) {
  EXPECT_EQ(told("G1 X1 M3"), "M3, motion");
  EXPECT_EQ(told("G1 X1 M4"), "M4, motion");
  EXPECT_EQ(told("G1 X1 M7"), "M7, motion");
  EXPECT_EQ(told("G1 X1 M8"), "M8, motion");
  EXPECT_EQ(told("G1 X1 M13"), "M13, motion");
}

TEST(BlockPlan, spindle_and_coolant_go_off_after_the_motion) {
  EXPECT_EQ(told("G1 X1 M5"), "motion, M5");
  EXPECT_EQ(told("G1 X1 M9"), "motion, M9");
  EXPECT_EQ(told("G1 X1 M19"), "motion, M19");
}

TEST(BlockPlan, the_position_of_a_word_in_its_block_does_not_matter) {
  EXPECT_EQ(told("M5 G1 X1"), "motion, M5");
  EXPECT_EQ(told("G1 X1 S500 M3"), "M3 S500, motion");
}

TEST(BlockPlan, s_t_and_the_first_m_of_the_begin_share_one_handshake) {
  EXPECT_EQ(told("M3 S1500"), "M3 S1500");
  EXPECT_EQ(told("T5 M6"), "M6 T5");
  EXPECT_EQ(told("T5 S1000 M8"), "M8 S1000 T5");
}

TEST(BlockPlan, s_and_t_without_an_m_have_a_handshake_of_their_own) {
  EXPECT_EQ(told("S100"), "S100");
  EXPECT_EQ(told("T3"), "T3");
  EXPECT_EQ(told("S100 M5"), "S100, M5");
}

TEST(BlockPlan, several_m_codes_go_one_after_the_other_as_written) {
  EXPECT_EQ(told("M8 M3 M10"), "M8, M3, M10");
  EXPECT_EQ(told("M09 M05"), "M9, M5");
}

TEST(BlockPlan, the_tool_change_precedes_the_spindle_start) {
  EXPECT_EQ(told("S900 M3 T2 M6"), "M6 S900 T2, M3");
}

TEST(BlockPlan, stop_and_end_come_after_all_else) {
  EXPECT_EQ(told("M30 M9 G1 X1"), "motion, M9, M30, end");
  EXPECT_EQ(told("M2"), "M2, end");
  EXPECT_EQ(told("M0 M5"), "M5, M0, stop");
  EXPECT_EQ(told("M1"), "M1, optional stop");
}

TEST(BlockPlan, m99_ends_the_program_and_never_goes_to_the_plc) { EXPECT_EQ(told("M99"), "end"); }

TEST(BlockPlan, overrides_are_not_waited_for) {
  EXPECT_EQ(plan("M49")->begin.front().acknowledgement, Acknowledgement::before_next_function);
  EXPECT_EQ(plan("M48")->end.front().acknowledgement, Acknowledgement::before_next_function);
}

TEST(BlockPlan, a_handshake_with_s_or_t_is_always_waited_for) {
  EXPECT_EQ(plan("M49 S100")->begin.front().acknowledgement, Acknowledgement::before_going_on);
}

TEST(BlockPlan, a_dwell_is_a_motion) { EXPECT_EQ(told("G4 P1 M5"), "motion, M5"); }

TEST(BlockPlan, m_codes_of_the_machine_builder_go_to_the_plc_before_the_motion) {
  EXPECT_EQ(told("G0 X1 M100"), "M100, motion");
  EXPECT_EQ(told("G0 X1 M199"), "M199, motion");
}

TEST(BlockPlan, an_m_code_that_the_machine_does_not_have_is_refused) {
  EXPECT_EQ(told("M70"), "line 3, word 'M70': the machine has no such M function");
}

TEST(BlockPlan, s_and_t_fit_a_plc_word_or_are_refused) {
  EXPECT_EQ(told("S65535"), "S65535");
  EXPECT_EQ(told("S65536"), "line 3, word 'S65536': the PLC takes whole numbers from 0 to 65535");
  EXPECT_EQ(told("S70000 M3"), "line 3, word 'S70000': the PLC takes whole numbers from 0 to 65535");
  EXPECT_EQ(told("S100.5"), "line 3, word 'S100.5': the PLC takes whole numbers from 0 to 65535");
  EXPECT_EQ(told("T65536"), "line 3, word 'T65536': the PLC takes whole numbers from 0 to 65535");
}

TEST(BlockPlan, a_program_is_checked_as_a_whole) {
  EXPECT_TRUE(check_for_machine(*parse_program("M3 S100\nM30")).has_value());
  const auto refused = check_for_machine(*parse_program("M3 S100\nM8\nT70000\nM30"));
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(to_string(refused.error()), "line 3, word 'T70000': the PLC takes whole numbers from 0 to 65535");
}

}  // namespace
}  // namespace kernel_mocks
