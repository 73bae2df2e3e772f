// What the PLC sees of the axes, and what they heed: DEN, M107, feed hold, feed enable, spindle at speed.
#include "tests/kernel_mocks/simulated/simulated_kernel.hpp"

namespace kernel_mocks {
namespace {

/// A poll, and what the requests around it cost.
constexpr auto poll = 1ms + 100us;

class MotionSignals : public SimulatedKernel {
 protected:
  void expect_lasts(const TimedPlc::Interval& motion, std::chrono::nanoseconds duration,
                    std::chrono::nanoseconds polls = 100us) {
    EXPECT_GE(motion.length(), duration);
    EXPECT_LE(motion.length(), duration + polls);
  }

  void press(std::chrono::nanoseconds at, OperatorEvent event) {
    script_.push_back({at, event});
    operator_.emplace(script_);
    runner.panel = &panel_;
    runner.operator_ = &*operator_;
  }

 private:
  OperatorPanel panel_;
  OperatorScript script_;
  std::optional<ScriptedOperator> operator_;
};

TEST_F(MotionSignals, den_is_off_for_just_the_duration_of_the_motion) {
  ASSERT_EQ(run_program("G1 X10 F600\nM30").outcome, RunOutcome::ended);
  ASSERT_EQ(plc.motions().size(), 1U);
  expect_lasts(plc.motions()[0], 1s);
}

TEST_F(MotionSignals, den_is_off_in_each_motion_and_on_between_two) {
  ASSERT_EQ(run_program("G0 X10\nG4 P0.5\nG1 X0 F600\nM30").outcome, RunOutcome::ended);
  ASSERT_EQ(plc.motions().size(), 3U);
  expect_lasts(plc.motions()[0], 60ms);
  expect_lasts(plc.motions()[1], 500ms);
  expect_lasts(plc.motions()[2], 1s);
}

TEST_F(MotionSignals, den_stays_on_when_motion_takes_no_time) {
  runner.axes.time_percent = 0;
  ASSERT_EQ(run_program("G0 X10\nG4 P0.5\nM30").outcome, RunOutcome::ended);
  EXPECT_TRUE(plc.motions().empty());
}

TEST_F(MotionSignals, den_is_on_before_a_function_of_the_blocks_end_is_given) {
  ASSERT_EQ(run_program("G1 X10 F600 M9\nM30").outcome, RunOutcome::ended);
  ASSERT_EQ(plc.motions().size(), 1U);
  EXPECT_LE(plc.motions()[0].end, plc.time_of("D100 = 9 0 0"));
  EXPECT_EQ(plc.count_of(m_strobe_in_motion), 0U);
}

TEST_F(MotionSignals, den_goes_off_after_the_fin_of_a_function_of_the_blocks_begin) {
  plc.durations[8] = 300ms;
  ASSERT_EQ(run_program("G1 X10 F600 M8\nM30").outcome, RunOutcome::ended);
  ASSERT_EQ(plc.motions().size(), 1U);
  EXPECT_GE(plc.motions()[0].begin, 300ms);
  EXPECT_EQ(plc.count_of(m_strobe_in_motion), 0U);
}

TEST_F(MotionSignals, m107_goes_off_before_z_leaves_the_tool_change_position) {
  ASSERT_EQ(run_program("G0 Z-10\nM30").outcome, RunOutcome::ended);
  EXPECT_LE(plc.time_of("M107 on"), plc.time_of("M107 off"));
  EXPECT_LE(plc.time_of("M107 off"), plc.motions().at(0).begin);
}

TEST_F(MotionSignals, m107_comes_on_after_z_has_arrived_there) {
  ASSERT_EQ(run_program("G0 Z-10\nG0 Z0\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(plc.time_of("M107 on", 1), plc.motions().at(1).end);
}

TEST_F(MotionSignals, m107_is_on_from_the_tool_change_position_upwards_and_told_only_when_it_changes) {
  runner.axes.tool_change_z = 50;
  ASSERT_EQ(run_program("G0 Z49.9\nG0 Z50\nG0 Z60\nM30").outcome, RunOutcome::ended);
  EXPECT_EQ(plc.count_of("M107 on"), 1U);
  EXPECT_EQ(plc.count_of("M107 off"), 1U);
  EXPECT_GE(plc.time_of("M107 on"), plc.motions().at(1).end);
}

TEST_F(MotionSignals, feed_hold_stops_the_motion_and_cycle_start_lets_it_go_on_where_it_was) {
  press(200ms, OperatorEvent::feed_hold);
  press(700ms, OperatorEvent::cycle_start);
  ASSERT_EQ(run_program("G1 X10 F600\nM30").outcome, RunOutcome::ended);
  ASSERT_EQ(plc.motions().size(), 1U);
  EXPECT_GE(plc.motions()[0].length(), 1500ms - poll);
  EXPECT_LE(plc.motions()[0].length(), 1500ms + poll);
}

TEST_F(MotionSignals, m106_is_on_during_a_feed_hold) {
  press(200ms, OperatorEvent::feed_hold);
  press(700ms, OperatorEvent::cycle_start);
  ASSERT_EQ(run_program("G1 X10 F600\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(plc.time_of("M106 off") - plc.time_of("M106 on"), 500ms - poll);
  EXPECT_LE(plc.time_of("M106 off") - plc.time_of("M106 on"), 500ms + poll);
}

TEST_F(MotionSignals, during_a_feed_hold_a_handshake_goes_on_and_no_block_begins) {
  plc.durations[8] = 300ms;
  press(100ms, OperatorEvent::feed_hold);
  press(900ms, OperatorEvent::cycle_start);
  ASSERT_EQ(run_program("M8\nM9\nM30").outcome, RunOutcome::ended);
  EXPECT_LT(plc.time_of(den_on), 310ms);
  EXPECT_GE(plc.time_of("D100 = 9 0 0"), 900ms - poll);
}

TEST_F(MotionSignals, a_motion_does_not_begin_in_a_feed_hold_of_its_own_block) {
  plc.durations[8] = 300ms;
  press(100ms, OperatorEvent::feed_hold);
  press(900ms, OperatorEvent::cycle_start);
  ASSERT_EQ(run_program("M8 G1 X10 F600\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(plc.motions().at(0).end, 900ms - poll + 1s);
}

TEST_F(MotionSignals, feed_enable_off_stops_the_motion_until_it_is_on_again) {
  plc.set_later(300ms, 125, false);
  plc.set_later(550ms, 125, true);
  ASSERT_EQ(run_program("G1 X10 F600\nM30").outcome, RunOutcome::ended);
  ASSERT_EQ(plc.motions().size(), 1U);
  EXPECT_GE(plc.motions()[0].length(), 1250ms - 2 * poll);
  EXPECT_LE(plc.motions()[0].length(), 1250ms + 2 * poll);
}

TEST_F(MotionSignals, feed_hold_and_feed_enable_together_hold_until_both_allow_motion) {
  plc.set_later(200ms, 125, false);
  plc.set_later(900ms, 125, true);
  press(300ms, OperatorEvent::feed_hold);
  press(600ms, OperatorEvent::cycle_start);
  ASSERT_EQ(run_program("G1 X10 F600\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(plc.motions().at(0).length(), 1700ms - 2 * poll);
  EXPECT_LE(plc.motions().at(0).length(), 1700ms + 2 * poll);
}

TEST_F(MotionSignals, no_motion_begins_while_feed_enable_is_off_a_dwell_does) {
  plc.port.set_bit(125, false);
  plc.set_later(2s, 125, true);
  ASSERT_EQ(run_program("G4 P0.5\nG1 X10 F600\nM30").outcome, RunOutcome::ended);
  expect_lasts(plc.motions().at(0), 500ms);
  EXPECT_GE(plc.motions().at(1).end, 3s);
}

TEST_F(MotionSignals, an_alarm_ends_the_motion_at_once) {
  plc.set_later(400ms, 121, true);
  plc.port.set_word(120, 9);
  const RunResult result = run_program("N10 G1 X10 F600\nM30");
  ASSERT_TRUE(result.failure.has_value());
  EXPECT_EQ(result.failure->fault, LogicFault::alarm);
  EXPECT_EQ(result.failure->alarm_number, 9);
  EXPECT_TRUE(result.message.starts_with("block N10 (line 1): PLC alarm 9")) << result.message;
  EXPECT_LT(plc.motions().at(0).length(), 410ms);
  EXPECT_TRUE(plc.port.bit(103)) << "DEN is on after the reset";
}

TEST_F(MotionSignals, a_feed_move_after_a_spindle_start_waits_for_spindle_at_speed) {
  plc.port.set_bit(123, false);
  plc.set_later(800ms, 123, true);
  ASSERT_EQ(run_program("S900 M3\nG1 X10 F600\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(plc.motions().at(0).begin, 800ms);
  EXPECT_LT(plc.motions().at(0).begin, 800ms + 2 * poll);
}

TEST_F(MotionSignals, so_does_an_arc) {
  plc.port.set_bit(123, false);
  plc.set_later(800ms, 123, true);
  ASSERT_EQ(run_program("S900 M4\nG3 X10 R5 F600\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(plc.motions().at(0).begin, 800ms);
}

TEST_F(MotionSignals, a_rapid_and_a_dwell_after_a_spindle_start_do_not_wait_the_feed_move_behind_them_does) {
  plc.port.set_bit(123, false);
  plc.set_later(800ms, 123, true);
  ASSERT_EQ(run_program("S900 M3\nG0 X10\nG4 P0.1\nG1 X20 F600\nM30").outcome, RunOutcome::ended);
  EXPECT_LT(plc.motions().at(0).begin, 20ms);
  EXPECT_LT(plc.motions().at(1).begin, 100ms);
  EXPECT_GE(plc.motions().at(2).begin, 800ms);
}

TEST_F(MotionSignals, without_a_spindle_start_or_after_its_stop_nothing_waits_for_the_speed) {
  plc.port.set_bit(123, false);
  ASSERT_EQ(run_program("G1 X10 F600\nS900 M3\nM5\nG1 X20\nM30").outcome, RunOutcome::ended);
}

TEST_F(MotionSignals, a_speed_that_does_not_come_is_a_fault_after_its_time) {
  plc.port.set_bit(123, false);
  runner.spindle_timeout = 2s;
  const RunResult result = run_program("S900 M3\nN20 G1 X10 F600\nM30");
  ASSERT_TRUE(result.failure.has_value());
  EXPECT_EQ(result.failure->fault, LogicFault::spindle_not_at_speed);
  EXPECT_GE(result.failure->after, 2s);
  EXPECT_LT(result.failure->after, 2s + poll);
  EXPECT_TRUE(result.message.starts_with("block N20 (line 2): the spindle has not come to speed"));
  EXPECT_TRUE(plc.motions().empty());
}

TEST_F(MotionSignals, an_open_emergency_stop_chain_ends_the_wait_for_the_speed) {
  plc.port.set_bit(123, false);
  plc.set_later(300ms, 122, false);
  const RunResult result = run_program("S900 M3\nG1 X10 F600\nM30");
  ASSERT_TRUE(result.failure.has_value());
  EXPECT_EQ(result.failure->fault, LogicFault::emergency_stop);
}

}  // namespace
}  // namespace kernel_mocks
