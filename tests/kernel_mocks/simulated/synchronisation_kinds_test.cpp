// The synchronisation kinds of the machine table: what of the program waits for FIN, and what does not.
//
// M50 is the function under test; the PLC needs 400 ms for it.
#include "tests/kernel_mocks/simulated/simulated_kernel.hpp"

namespace kernel_mocks {
namespace {

class SynchronisationKinds : public SimulatedKernel {
 protected:
  SynchronisationKinds() {
    plc.durations[50] = duration;
    runner.machine_table = &table_;
  }

  void m50_is(EffectPoint effect, Acknowledgement acknowledgement, bool sent = true) {
    table_.put({.code = 50, .effect = effect, .acknowledgement = acknowledgement, .sent_to_plc = sent});
  }

  /// When the strobe of M50 rose and when it fell: FIN.
  std::chrono::nanoseconds given() { return plc.time_of("D100 = 50 0 0"); }
  std::chrono::nanoseconds fin() { return given() + duration; }
  TimedPlc::Interval motion(std::size_t index) {
    const auto motions = plc.motions();
    if (index < motions.size()) return motions[index];
    ADD_FAILURE() << "only " << motions.size() << " motions";
    return {};
  }

  static constexpr std::chrono::nanoseconds duration = 400ms;
  static constexpr std::chrono::nanoseconds soon = 10ms;

 private:
  MachineTable table_ = MachineTable::standard();
};

TEST_F(SynchronisationKinds, no_synch_is_never_sent) {
  m50_is(EffectPoint::begin, Acknowledgement::before_going_on, false);
  ASSERT_EQ(run_program("M50 G0 X10\nM30").outcome, RunOutcome::ended);
  EXPECT_EQ(plc.count_of("D100 = 50 0 0"), 0U);
}

TEST_F(SynchronisationKinds, mvs_svs_is_given_before_the_motion_which_waits_for_fin) {
  m50_is(EffectPoint::begin, Acknowledgement::before_going_on);
  ASSERT_EQ(run_program("M50 G0 X10\nM30").outcome, RunOutcome::ended);
  EXPECT_LT(given(), soon);
  EXPECT_GE(motion(0).begin, fin());
}

TEST_F(SynchronisationKinds, mvs_sns_is_given_before_the_motion_which_runs_meanwhile) {
  m50_is(EffectPoint::begin, Acknowledgement::at_block_end);
  ASSERT_EQ(run_program("M50 G0 X10\nM30").outcome, RunOutcome::ended);
  EXPECT_LT(given(), motion(0).begin);
  EXPECT_LT(motion(0).begin, soon);
  EXPECT_LT(motion(0).length(), 61ms);
}

TEST_F(SynchronisationKinds, mvs_sns_holds_the_next_block_until_fin) {
  m50_is(EffectPoint::begin, Acknowledgement::at_block_end);
  ASSERT_EQ(run_program("M50 G0 X10\nG0 X0\nM30").outcome, RunOutcome::ended);
  EXPECT_LT(motion(0).end, fin());
  EXPECT_GE(motion(1).begin, fin());
}

TEST_F(SynchronisationKinds, mvs_sns_lets_a_longer_motion_end_first) {
  m50_is(EffectPoint::begin, Acknowledgement::at_block_end);
  ASSERT_EQ(run_program("M50 G0 X100\nG0 X0\nM30").outcome, RunOutcome::ended);
  EXPECT_GT(motion(0).end, fin());
  EXPECT_LT(motion(0).length(), 601ms);
  EXPECT_LT(motion(1).begin - motion(0).end, soon);
}

TEST_F(SynchronisationKinds, mvs_sns_holds_the_functions_of_the_blocks_end) {
  m50_is(EffectPoint::begin, Acknowledgement::at_block_end);
  ASSERT_EQ(run_program("M50 G0 X10 M9\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(plc.time_of("D100 = 9 0 0"), fin());
}

TEST_F(SynchronisationKinds, mns_sns_is_given_after_the_motion_and_holds_the_next_block) {
  m50_is(EffectPoint::end, Acknowledgement::before_going_on);
  ASSERT_EQ(run_program("M50 G0 X10\nG0 X0\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(given(), motion(0).end);
  EXPECT_GE(motion(1).begin, fin());
}

TEST_F(SynchronisationKinds, mos_lets_motion_of_its_block_and_of_the_next_ones_run) {
  m50_is(EffectPoint::begin, Acknowledgement::before_next_function);
  ASSERT_EQ(run_program("M50 G0 X10\nG1 X11 F600\nM30").outcome, RunOutcome::ended);
  EXPECT_LT(given(), motion(0).begin);
  EXPECT_LT(motion(1).end, fin());
}

TEST_F(SynchronisationKinds, mos_holds_the_next_function) {
  m50_is(EffectPoint::begin, Acknowledgement::before_next_function);
  ASSERT_EQ(run_program("M50\nG0 X10\nM8\nM30").outcome, RunOutcome::ended);
  EXPECT_LT(motion(0).end, fin());
  EXPECT_GE(plc.time_of("D100 = 8 0 0"), fin());
}

TEST_F(SynchronisationKinds, mos_at_the_end_of_its_block_comes_after_the_motion) {
  m50_is(EffectPoint::end, Acknowledgement::before_next_function);
  ASSERT_EQ(run_program("M50 G0 X10\nG0 X0\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(given(), motion(0).end);
  EXPECT_LT(motion(1).begin, fin());
}

TEST_F(SynchronisationKinds, mvs_slm_lets_rapids_run_and_holds_the_next_motion_at_feed) {
  m50_is(EffectPoint::begin, Acknowledgement::before_feed);
  ASSERT_EQ(run_program("M50 G0 X10\nG0 X0\nG1 X1 F600\nM30").outcome, RunOutcome::ended);
  EXPECT_LT(motion(0).begin, soon);
  EXPECT_LT(motion(1).end, fin());
  EXPECT_GE(motion(2).begin, fin());
}

TEST_F(SynchronisationKinds, mvs_slm_holds_the_motion_of_its_own_block_when_that_is_at_feed) {
  m50_is(EffectPoint::begin, Acknowledgement::before_feed);
  ASSERT_EQ(run_program("M50 G1 X1 F600\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(motion(0).begin, fin());
}

TEST_F(SynchronisationKinds, mvs_slm_holds_the_next_function_too) {
  m50_is(EffectPoint::begin, Acknowledgement::before_feed);
  ASSERT_EQ(run_program("M50 G0 X10\nM8\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(plc.time_of("D100 = 8 0 0"), fin());
}

TEST_F(SynchronisationKinds, a_function_that_nothing_waits_for_is_acknowledged_before_the_program_ends) {
  m50_is(EffectPoint::begin, Acknowledgement::before_next_function);
  ASSERT_EQ(run_program("%\nM50\n%").outcome, RunOutcome::ended);
  EXPECT_GE(plc.time_of("M104 off"), fin());
}

TEST_F(SynchronisationKinds, a_function_that_shares_its_fin_with_s_or_t_holds_the_block) {
  m50_is(EffectPoint::begin, Acknowledgement::before_next_function);
  ASSERT_EQ(run_program("M50 T4 G0 X10\nM30").outcome, RunOutcome::ended);
  EXPECT_GE(motion(0).begin, duration);
}

TEST_F(SynchronisationKinds,
       the_alarm_of_a_function_that_nothing_waits_for_ends_the_motion_that_runs_meanwhile) {
  m50_is(EffectPoint::begin, Acknowledgement::before_next_function);
  plc.set_later(200ms, 121, true);
  const RunResult result = run_program("M50\nG0 X100\nM30");
  ASSERT_TRUE(result.failure.has_value());
  EXPECT_EQ(result.failure->fault, LogicFault::alarm);
  EXPECT_LT(motion(0).length(), 220ms);
}

}  // namespace
}  // namespace kernel_mocks
