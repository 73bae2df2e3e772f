// The handshake of the machine program, step by step, in time that the test makes.
#include "emulator_models/machine_program.hpp"

#include <gtest/gtest.h>

#include "tests/emulator_models/machine_rig.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using Events = std::vector<std::string>;

class MachineProgramTest : public ::testing::Test, public MachineRig {
 protected:
  MachineProgramTest() { run_for(100ms); }

  void strobe_m(unsigned code) {
    set("D100", code);
    set("M100", 1);
  }
  void drop_strobes() {
    for (const auto* strobe : {"M100", "M101", "M102"}) set(strobe, 0);
    scan_once();
  }
  /// A whole handshake of one M function.
  /// @return the time from the strobe to FIN
  std::chrono::milliseconds do_m(unsigned code) {
    strobe_m(code);
    const auto duration = run_until_on("M120");
    drop_strobes();
    EXPECT_EQ(get("M120"), 0U);
    return duration;
  }
};

TEST_F(MachineProgramTest, stands_ready_at_power_up) {
  EXPECT_EQ(get("M120"), 0U);  // FIN
  EXPECT_EQ(get("M121"), 0U);  // alarm
  for (const auto* signal : {"M122", "M124", "M125", "M126"}) EXPECT_EQ(get(signal), 1U) << signal;
  EXPECT_EQ(get("M123"), 0U);  // spindle at speed
}

TEST_F(MachineProgramTest, m3_gets_fin_when_the_spindle_is_at_speed_and_not_before) {
  strobe_m(3);
  scan_once();
  EXPECT_TRUE(output("Y0"));
  EXPECT_EQ(get("M120"), 0U);
  EXPECT_EQ(get("M125"), 0U);  // no feed while the spindle runs up
  run_for(500ms);              // the plant sees the output one scan after the program has set it
  EXPECT_EQ(get("M120"), 0U);
  scan_once();
  EXPECT_EQ(get("M120"), 1U);
  EXPECT_EQ(get("M123"), 1U);
  EXPECT_EQ(get("M125"), 1U);
  EXPECT_EQ(take_events(), (Events{"start M3", "finish M3"}));
}

TEST_F(MachineProgramTest, fin_stays_until_the_strobe_is_low_and_falls_then) {
  strobe_m(99);
  EXPECT_EQ(run_until_on("M120"), 10ms);
  run_for(5s);
  EXPECT_EQ(get("M120"), 1U);
  set("M100", 0);
  EXPECT_EQ(get("M120"), 1U);
  scan_once();
  EXPECT_EQ(get("M120"), 0U);
}

TEST_F(MachineProgramTest, one_strobe_starts_its_function_once) {
  strobe_m(8);
  run_for(10s);
  drop_strobes();
  run_for(1s);
  EXPECT_EQ(take_events(), (Events{"start M8", "finish M8"}));
}

TEST_F(MachineProgramTest, the_code_is_read_when_the_strobe_rises_and_not_again) {
  strobe_m(3);
  scan_once();
  set("D100", 8);
  run_until_on("M120");
  EXPECT_EQ(take_events(), (Events{"start M3", "finish M3"}));
  EXPECT_FALSE(output("Y2"));
}

TEST_F(MachineProgramTest, fin_waits_for_all_functions_that_are_strobed) {
  set("D101", 1200);
  set("D102", 7);
  set("M101", 1);
  set("M102", 1);
  strobe_m(3);
  scan_once();
  EXPECT_EQ(take_events(), (Events{"start T7", "finish T7", "start S1200", "finish S1200", "start M3"}));
  EXPECT_EQ(get("M120"), 0U);
  EXPECT_EQ(get("D110"), 7U);
  EXPECT_EQ(get("D112"), 1200U);
  run_until_on("M120");
  EXPECT_EQ(take_events(), (Events{"finish M3"}));
  set("M100", 0);
  run_for(100ms);
  EXPECT_EQ(get("M120"), 1U);  // S and T are still strobed
  drop_strobes();
  EXPECT_EQ(get("M120"), 0U);
}

TEST_F(MachineProgramTest, a_strobe_that_joins_while_another_function_runs_is_waited_for_too) {
  strobe_m(8);
  run_for(100ms);
  set("D102", 3);
  set("M102", 1);
  scan_once();
  EXPECT_EQ(take_events(), (Events{"start M8", "start T3", "finish T3"}));
  EXPECT_EQ(get("M120"), 0U);
  run_until_on("M120");
  EXPECT_EQ(take_events(), (Events{"finish M8"}));
}

TEST_F(MachineProgramTest, a_new_speed_of_a_turning_spindle_is_done_when_it_is_at_speed_again) {
  do_m(3);
  take_events();
  set("D101", 3000);
  set("M101", 1);
  scan_once();
  EXPECT_EQ(get("M120"), 0U);
  EXPECT_EQ(run_until_on("M120"), 510ms);
  EXPECT_EQ(take_events(), (Events{"start S3000", "finish S3000"}));
}

TEST_F(MachineProgramTest, a_reversal_goes_through_standstill_and_never_drives_both_ways) {
  do_m(3);
  strobe_m(4);
  for (int scans = 0; scans < 200 && get("M120") == 0; ++scans) {
    scan_once();
    ASSERT_FALSE(output("Y0") && output("Y1"));
    ASSERT_FALSE(get("Y0") != 0 && get("Y1") != 0);
  }
  EXPECT_TRUE(output("Y1"));
  EXPECT_EQ(take_events(), (Events{"start M3", "finish M3", "start M4", "finish M4"}));
}

TEST_F(MachineProgramTest, a_reversal_takes_the_time_to_stop_and_the_time_to_run_up) {
  do_m(3);
  EXPECT_GE(do_m(4), 2 * MachinePlant::spindle_time);
}

TEST_F(MachineProgramTest, m5_gets_fin_at_standstill) {
  do_m(4);
  EXPECT_GE(do_m(5), MachinePlant::spindle_time);
  EXPECT_FALSE(output("Y1"));
  EXPECT_EQ(do_m(5), 10ms);  // stands already
}

TEST_F(MachineProgramTest, coolant_gets_fin_with_its_own_flow_switch) {
  EXPECT_GE(do_m(8), MachinePlant::coolant_time);
  EXPECT_TRUE(output("Y2"));
  EXPECT_GE(do_m(7), MachinePlant::coolant_time);
  EXPECT_TRUE(output("Y3"));
  do_m(9);
  EXPECT_FALSE(output("Y2"));
  EXPECT_FALSE(output("Y3"));
}

TEST_F(MachineProgramTest, m13_and_m14_are_spindle_and_flood_in_one) {
  EXPECT_GE(do_m(13), MachinePlant::spindle_time + MachinePlant::coolant_time);
  EXPECT_TRUE(output("Y0") && output("Y2"));
  do_m(0);
  do_m(14);
  EXPECT_TRUE(output("Y1") && output("Y2"));
}

TEST_F(MachineProgramTest, m6_stops_the_spindle_and_then_puts_the_selected_tool_in) {
  do_m(3);
  set("D102", 5);
  set("M102", 1);
  strobe_m(6);
  scan_once();
  EXPECT_FALSE(output("Y0"));
  EXPECT_FALSE(output("Y4"));  // the spindle has not come to rest
  EXPECT_GE(run_until_on("M120"), MachinePlant::spindle_time + MachinePlant::tool_change_time);
  EXPECT_FALSE(output("Y4") || output("Y5"));
  EXPECT_EQ(get("D111"), 5U);
}

TEST_F(MachineProgramTest, program_stop_and_program_end_switch_spindle_and_coolant_off_before_fin) {
  for (const unsigned code : {0U, 1U, 2U, 30U, 60U}) {
    SCOPED_TRACE(code);
    do_m(13);
    do_m(7);
    strobe_m(code);
    run_until_on("M120");
    for (const auto* off : {"Y0", "Y2", "Y3", "X0", "X2", "X3"}) EXPECT_EQ(get(off), 0U) << off;
    EXPECT_EQ(get("X1"), 1U);
    drop_strobes();
  }
}

TEST_F(MachineProgramTest, an_m_function_that_the_machine_has_not_is_finished_at_once) {
  EXPECT_EQ(do_m(77), 10ms);
  EXPECT_EQ(do_m(0xFFFF), 10ms);
  EXPECT_EQ(take_events(), (Events{"start M77", "finish M77", "start M65535", "finish M65535"}));
}

TEST_F(MachineProgramTest, reset_abandons_the_action_and_switches_off) {
  strobe_m(6);
  run_for(500ms);
  EXPECT_TRUE(output("Y4"));
  set("M105", 1);
  scan_once();
  EXPECT_FALSE(output("Y4") || output("Y5"));
  EXPECT_EQ(get("M126"), 0U);
  set("M105", 0);
  run_for(10s);
  EXPECT_EQ(get("M120"), 0U);  // the old strobe is still on and must not count
  EXPECT_EQ(take_events(), (Events{"start M6"}));
  drop_strobes();
  EXPECT_GT(do_m(6), 0ms);
  EXPECT_EQ(take_events(), (Events{"start M6", "finish M6"}));
}

TEST_F(MachineProgramTest, reset_drops_fin) {
  strobe_m(99);
  run_until_on("M120");
  set("M105", 1);
  scan_once();
  EXPECT_EQ(get("M120"), 0U);
}

TEST_F(MachineProgramTest, a_strobe_withdrawn_before_fin_ends_the_wait_and_the_tool_change) {
  strobe_m(6);
  run_for(500ms);
  drop_strobes();
  EXPECT_FALSE(output("Y4") || output("Y5"));
  run_for(5s);
  EXPECT_EQ(get("M120"), 0U);
  EXPECT_EQ(take_events(), (Events{"start M6"}));
}

TEST_F(MachineProgramTest, the_emergency_stop_drops_everything_at_once_and_stays_an_alarm_until_a_reset) {
  do_m(13);
  plant.set_emergency_stop_pressed(true);
  scan_once();
  EXPECT_FALSE(output("Y0") || output("Y2"));
  EXPECT_EQ(get("M121"), 1U);
  EXPECT_EQ(get("D120"), 1U);
  EXPECT_EQ(get("M122"), 0U);
  EXPECT_EQ(get("M126"), 0U);

  plant.set_emergency_stop_pressed(false);
  strobe_m(3);
  set("Y2", 1);  // forced from outside
  run_for(2s);
  EXPECT_FALSE(output("Y0") || output("Y2"));
  EXPECT_EQ(get("M121"), 1U);
  EXPECT_EQ(get("M122"), 1U);

  drop_strobes();
  set("M105", 1);
  scan_once();
  set("M105", 0);
  scan_once();
  EXPECT_EQ(get("M121"), 0U);
  EXPECT_EQ(get("D120"), 0U);
  EXPECT_EQ(get("M126"), 1U);
}

TEST_F(MachineProgramTest, a_reset_does_not_clear_an_alarm_whose_cause_is_still_there) {
  plant.set_emergency_stop_pressed(true);
  set("M105", 1);
  run_for(100ms);
  EXPECT_EQ(get("D120"), 1U);
}

TEST_F(MachineProgramTest, an_open_door_stops_the_spindle_and_keeps_it_from_starting) {
  do_m(3);
  plant.set_door_closed(false);
  scan_once();
  EXPECT_FALSE(output("Y0"));
  EXPECT_EQ(get("D120"), 2U);
  EXPECT_EQ(get("M124"), 0U);

  set("M105", 1);
  scan_once();
  set("M105", 0);
  strobe_m(3);
  for (int i = 0; i < 100; ++i) {
    scan_once();
    ASSERT_FALSE(output("Y0"));
  }
  EXPECT_EQ(get("D120"), 2U);
  EXPECT_EQ(get("M120"), 0U);
}

TEST_F(MachineProgramTest, a_feedback_that_does_not_come_is_an_alarm_and_no_fin) {
  plant.set_coolant_blocked(true);
  strobe_m(8);
  run_for(5s + 10ms);
  EXPECT_EQ(get("D120"), 0U);
  scan_once();
  EXPECT_EQ(get("D120"), 3U);
  EXPECT_EQ(get("M120"), 0U);
  EXPECT_FALSE(output("Y2"));
}

TEST_F(MachineProgramTest, lamps_show_running_waiting_and_alarm) {
  const auto lamps = [&] {
    scan_once();
    return std::vector{get("Y10"), get("Y11"), get("Y12")};
  };
  EXPECT_EQ(lamps(), (std::vector{0U, 1U, 0U}));
  set("M104", 1);
  EXPECT_EQ(lamps(), (std::vector{1U, 0U, 0U}));
  set("M106", 1);
  EXPECT_EQ(lamps(), (std::vector{0U, 1U, 0U}));
  plant.set_emergency_stop_pressed(true);
  EXPECT_EQ(lamps(), (std::vector{0U, 0U, 1U}));
}

TEST_F(MachineProgramTest, a_stop_and_a_new_run_begin_with_all_outputs_off) {
  do_m(13);
  set("M8037", 1);
  scan_once();
  EXPECT_FALSE(output("Y0") || output("Y2"));
  set("M8035", 1);
  set("M8036", 1);
  run_for(100ms);
  EXPECT_FALSE(output("Y0") || output("Y2"));
  EXPECT_EQ(get("M126"), 1U);
}

TEST_F(MachineProgramTest, a_strobe_kept_over_a_stop_is_not_executed_again) {
  set("M8033", 1);  // keeps the memory
  strobe_m(8);
  run_until_on("M120");
  set("M8037", 1);
  scan_once();
  set("M8035", 1);
  set("M8036", 1);
  run_for(1s);
  EXPECT_EQ(take_events(), (Events{"start M8", "finish M8"}));
}

TEST(MachineProgramAtPowerUp, a_strobe_that_is_there_before_the_first_scan_is_served) {
  MachineRig rig;
  rig.set("D100", 99);
  rig.set("M100", 1);
  rig.scan_once();
  EXPECT_EQ(rig.get("M120"), 1U);
}

}  // namespace
}  // namespace emulator_models
