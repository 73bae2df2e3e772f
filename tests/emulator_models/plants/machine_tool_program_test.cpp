// The program of the machine tool on its plant: functions and their feedback, tool changes, failures, restart.
#include "emulator_models/programs/machine_tool_program.hpp"

#include <functional>

#include <gtest/gtest.h>

#include "tests/emulator_models/plants/machine_tool_rig.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using machine_tool::X;
using machine_tool::Y;

/// With scans of 1 ms and of 10 ms.
struct MachineToolProgram : ::testing::TestWithParam<int> {
  MachineToolRig rig{machine_tool_program(), std::chrono::milliseconds{GetParam()}};
  ~MachineToolProgram() override { EXPECT_EQ(rig.broken, std::set<std::string>{}); }
};
INSTANTIATE_TEST_SUITE_P(scans, MachineToolProgram, ::testing::Values(1, 10));

TEST_P(MachineToolProgram, starts_with_the_emergency_stop_and_needs_a_reset) {
  rig.run_for(1s);
  EXPECT_EQ(rig.alarm(), 1);
  EXPECT_FALSE(rig.on(Y::contactor));
  rig.switch_on();
  EXPECT_EQ(rig.alarm(), 0);
  EXPECT_TRUE(rig.m(126));
  EXPECT_TRUE(rig.m(125));
}

TEST_P(MachineToolProgram, each_function_gets_fin_after_its_feedback) {
  rig.switch_on();
  EXPECT_LT(rig.set_speed(3000), 50ms);
  EXPECT_GE(rig.execute(3), 650ms);
  EXPECT_NEAR(rig.d(200), 3000, 330);
  EXPECT_GE(rig.execute(4), 2s) << "through zero speed";
  EXPECT_GE(rig.set_speed(1000), 200ms);
  EXPECT_GE(rig.execute(8), 500ms);
  EXPECT_GE(rig.execute(7), 300ms);
  EXPECT_LT(rig.execute(9), 100ms);
  EXPECT_GE(rig.execute(19), 300ms);
  EXPECT_TRUE(rig.on(X::spindle_oriented));
  EXPECT_GE(rig.execute(13), 500ms);
  EXPECT_GE(rig.execute(30), 500ms);
  EXPECT_TRUE(rig.moves_nothing());
  EXPECT_GE(rig.execute(11), 400ms);
  EXPECT_GE(rig.execute(10), 400ms);
  EXPECT_LT(rig.execute(48), 50ms);
  EXPECT_EQ(rig.alarm(), 0);
}

TEST_P(MachineToolProgram, fin_falls_after_the_strobes_and_serves_all_of_them) {
  rig.switch_on();
  rig.give(3);
  rig.give_s(500);
  rig.give_t(4);
  rig.run_for(200ms);
  EXPECT_FALSE(rig.m(120));
  rig.run_for(2s);
  EXPECT_TRUE(rig.m(120));
  rig.set_m(100, false);
  rig.set_m(101, false);
  rig.run_for(50ms);
  EXPECT_TRUE(rig.m(120));
  rig.set_m(102, false);
  rig.run_for(50ms);
  EXPECT_FALSE(rig.m(120));
  EXPECT_EQ(rig.d(220), 4);
}

TEST_P(MachineToolProgram, tools_are_changed_the_short_way_and_found_again) {
  rig.switch_on();
  for (const int tool : {1, 12, 5, 1, 0, 7}) {
    rig.select_tool(tool);
    EXPECT_LT(rig.execute(6), 15s) << tool << " alarm " << rig.alarm();
    EXPECT_EQ(rig.plant.changer().tool_in_spindle(), tool);
    EXPECT_EQ(rig.d(221), tool);
  }
  rig.select_tool(7);
  EXPECT_LT(rig.execute(6), 100ms) << "is in the spindle already";
}

TEST_P(MachineToolProgram, the_magazine_takes_no_more_than_half_a_turn) {
  rig.switch_on();
  rig.select_tool(1);
  const auto base = rig.execute(6);
  rig.select_tool(11);
  const auto two_pockets = rig.execute(6);
  EXPECT_LT(two_pockets, base + 2 * 800ms + 300ms);
}

TEST_P(MachineToolProgram, an_unknown_tool_is_an_alarm) {
  rig.switch_on();
  rig.select_tool(13);
  EXPECT_EQ(rig.alarm(), 31);
  rig.reset();
  EXPECT_EQ(rig.alarm(), 0);
}

TEST_P(MachineToolProgram, a_strobe_on_over_a_restart_is_not_executed_again) {
  rig.switch_on();
  rig.give(8);
  rig.run_for(100ms);
  rig.restart();
  rig.run_for(100ms);
  rig.reset();
  rig.run_for(2s);
  EXPECT_FALSE(rig.on(Y::flood_pump));
  EXPECT_FALSE(rig.m(120));
  rig.take_back_strobes();
  EXPECT_LT(rig.execute(8), 1s);
}

TEST_P(MachineToolProgram, a_strobe_on_over_a_reset_counts_no_more) {
  rig.switch_on();
  rig.give(3);
  rig.run_for(100ms);
  rig.reset();
  rig.run_for(2s);
  EXPECT_TRUE(rig.moves_nothing());
  EXPECT_FALSE(rig.m(120));
}

TEST_P(MachineToolProgram, an_emergency_stop_drops_everything_and_needs_an_edge) {
  rig.switch_on();
  rig.execute(13);
  rig.plant.set_emergency_stop_pressed(true);
  rig.run_for(30ms);
  EXPECT_EQ(rig.alarm(), 1);
  EXPECT_TRUE(rig.moves_nothing());
  EXPECT_FALSE(rig.on(Y::contactor) || rig.on(Y::hydraulic_pump));
  rig.set_m(105, true);
  rig.run_for(1s);
  rig.plant.set_emergency_stop_pressed(false);
  rig.run_for(1s);
  EXPECT_EQ(rig.alarm(), 1) << "the level does not arm";
  rig.set_m(105, false);
  rig.run_for(50ms);
  rig.reset();
  EXPECT_EQ(rig.alarm(), 0);
  rig.run_for(2s);
  EXPECT_TRUE(rig.moves_nothing());
  rig.execute(3);
  EXPECT_EQ(rig.alarm(), 0);
}

TEST_P(MachineToolProgram, the_door_opens_at_standstill_only_and_stops_feed) {
  rig.switch_on();
  rig.execute(3);
  rig.plant.set_door_button_pressed(true);
  rig.plant.set_door_pulled_open(true);
  rig.run_for(1s);
  EXPECT_TRUE(rig.on(X::door_closed));
  rig.execute(5);
  rig.run_for(200ms);
  EXPECT_FALSE(rig.on(X::door_closed) || rig.m(125) || rig.m(126) || rig.m(124));
  EXPECT_EQ(rig.alarm(), 0);
  rig.execute(3);
  EXPECT_EQ(rig.alarm(), 2);
  rig.plant.set_door_button_pressed(false);
  rig.plant.set_door_pulled_open(false);
  rig.run_for(500ms);
  rig.reset();
  rig.execute(3);
  EXPECT_EQ(rig.alarm(), 0);
}

TEST_P(MachineToolProgram, the_spindle_does_not_start_on_an_open_chuck) {
  rig.switch_on();
  rig.execute(11);
  rig.execute(3);
  EXPECT_EQ(rig.alarm(), 5);
  rig.reset();
  rig.execute(10);
  rig.execute(3);
  EXPECT_EQ(rig.alarm(), 0);
}

TEST_P(MachineToolProgram, an_idle_scan_is_short) {
  rig.switch_on();
  rig.scan();
  EXPECT_LT(rig.instructions_of_last_scan, 600U);
  RecordProperty("idle_instructions", static_cast<int>(rig.instructions_of_last_scan));
}

TEST_P(MachineToolProgram, a_missing_lubrication_lets_the_cycle_finish) {
  rig.plant.set_failure(MachineToolFailure::lubrication_pressure_missing, true);
  rig.switch_on();
  EXPECT_EQ(rig.d(121), 11);
  EXPECT_FALSE(rig.m(126));
  EXPECT_LT(rig.execute(3), 2s) << "the cycle may finish";
  rig.plant.set_failure(MachineToolFailure::lubrication_pressure_missing, false);
  rig.reset();
  rig.run_for(13s);
  EXPECT_EQ(rig.d(121), 0);
  EXPECT_TRUE(rig.m(126));
}

TEST_P(MachineToolProgram, lubricates_after_20_minutes_of_motion) {
  rig.switch_on();
  rig.set_m(104, true);
  rig.set_m(103, false);
  rig.set_d(117, 1198);
  rig.run_for(1s);
  EXPECT_FALSE(rig.on(Y::lubrication_pump));
  rig.run_for(2s);
  EXPECT_TRUE(rig.on(Y::lubrication_pump));
  rig.run_for(12s);
  EXPECT_FALSE(rig.on(Y::lubrication_pump));
}

struct FailureCase {
  MachineToolFailure failure;
  int m_code;  ///< during which it strikes
  int alarm;
  int millis = 10;  ///< after the strobe
};

struct MachineToolFailures : ::testing::TestWithParam<FailureCase> {};

TEST_P(MachineToolFailures, end_in_their_alarm_with_safe_outputs_and_recover) {
  const FailureCase& c = GetParam();
  MachineToolRig rig{machine_tool_program()};
  rig.switch_on();
  rig.select_tool(3);
  rig.give(c.m_code);
  rig.run_for(std::chrono::milliseconds{c.millis});
  rig.plant.set_failure(c.failure, true);
  rig.run_for(25s);
  EXPECT_EQ(rig.alarm(), c.alarm);
  EXPECT_TRUE(rig.moves_nothing());
  EXPECT_FALSE(rig.m(120) || rig.m(125) || rig.m(126));
  EXPECT_TRUE(rig.on(Y::red_lamp));
  rig.take_back_strobes();
  rig.plant.set_failure(c.failure, false);
  rig.run_for(2s);  // pressure takes its time to come back
  EXPECT_EQ(rig.alarm(), c.alarm) << "repair alone clears nothing";
  rig.reset();
  rig.run_for(15s);
  EXPECT_LT(rig.execute(c.m_code), 20s);
  EXPECT_EQ(rig.alarm(), 0);
  EXPECT_EQ(rig.broken, std::set<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(
    all, MachineToolFailures,
    ::testing::Values(FailureCase{MachineToolFailure::spindle_drive_fault, 3, 4},
                      FailureCase{MachineToolFailure::flood_without_flow, 8, 6},
                      FailureCase{MachineToolFailure::flood_without_flow, 8, 6, 2000},
                      FailureCase{MachineToolFailure::mist_without_flow, 7, 6},
                      FailureCase{MachineToolFailure::coolant_motor_overload, 8, 8},
                      FailureCase{MachineToolFailure::hydraulic_pressure_missing, 3, 9, 2000},
                      FailureCase{MachineToolFailure::hydraulic_pressure_missing, 9, 9},
                      FailureCase{MachineToolFailure::hydraulic_motor_overload, 3, 10, 2000},
                      FailureCase{MachineToolFailure::chuck_stuck, 11, 3},
                      FailureCase{MachineToolFailure::door_lock_broken, 3, 2, 2000},
                      FailureCase{MachineToolFailure::over_travel, 3, 1, 1000},
                      FailureCase{MachineToolFailure::drives_not_ready, 13, 1, 1000},
                      FailureCase{MachineToolFailure::magazine_motor_overload, 6, 30, 500},
                      FailureCase{MachineToolFailure::magazine_stuck, 6, 22},
                      FailureCase{MachineToolFailure::pocket_pulse_lost, 6, 22, 500},
                      FailureCase{MachineToolFailure::pocket_stuck, 6, 23},
                      FailureCase{MachineToolFailure::arm_stuck, 6, 24},
                      FailureCase{MachineToolFailure::tool_clamp_stuck, 6, 25}),
    [](const auto& tried) {
      return "failure_" + std::to_string(static_cast<int>(tried.param.failure)) + "_in_m" +
             std::to_string(tried.param.m_code) + "_after_" + std::to_string(tried.param.millis);
    });

TEST(MachineToolRestart, takes_no_reset_that_is_on_already_for_an_edge) {
  MachineToolRig rig{machine_tool_program()};
  rig.set_m(105, true);
  rig.run_for(200ms);
  EXPECT_FALSE(rig.m(122));
  rig.set_m(105, false);
  rig.run_for(50ms);
  rig.reset();
  EXPECT_TRUE(rig.m(122));
}

TEST(MachineToolRestart, keeps_the_tools_and_forgets_where_the_magazine_stands) {
  MachineToolRig rig{machine_tool_program()};
  rig.switch_on();
  rig.select_tool(4);
  rig.execute(6);
  EXPECT_NE(rig.d(222), 0);
  rig.restart();
  rig.scan();
  EXPECT_EQ(rig.d(222), 0);
  EXPECT_EQ(rig.d(221), 4);
  EXPECT_EQ(rig.d(223), 0);
}

TEST(MachineToolRestart, in_an_exchange_leaves_it_in_doubt_until_somebody_has_looked) {
  MachineToolRig rig{machine_tool_program()};
  rig.switch_on();
  rig.select_tool(4);
  rig.give(6);
  for (int scans = 0; rig.d(115) != 5 && scans < 3000; ++scans) rig.scan();
  ASSERT_EQ(rig.d(115), 5);
  EXPECT_EQ(rig.d(223), 1);
  rig.restart();
  rig.scan();
  EXPECT_EQ(rig.d(223), 2);
  rig.take_back_strobes();
  rig.switch_on();
  rig.select_tool(7);
  rig.execute(6);
  EXPECT_EQ(rig.alarm(), 32);
}

/// Whatever happens to its pulses, the magazine is no reason for a wrong tool: the change ends with the right one, or in
/// alarm 22.
struct MachineToolMagazine : ::testing::TestWithParam<int> {
  void SetUp() override {
    rig.switch_on();
    rig.select_tool(start_tool);
    rig.execute(6);
    ASSERT_EQ(rig.d(222), start_tool);
  }
  /// Calls `disturb` when so much time has passed since the strobe.
  void change_to(int tool, std::chrono::milliseconds at, const std::function<void()>& disturb) {
    rig.select_tool(tool);
    rig.give(6);
    if (at > 0ms) rig.run_for(at);
    disturb();
    const SteadyTime begin = rig.now;
    do rig.scan();
    while (!rig.m(120) && rig.alarm() == 0 && rig.now - begin < 30s);
    EXPECT_EQ(rig.alarm(), rig.m(120) ? 0 : 22);
    EXPECT_EQ(rig.broken, std::set<std::string>{})
        << rig.plant.changer().tool_in_spindle() << " for " << tool;
  }
  void lose_pulses_for(std::chrono::milliseconds duration) {
    rig.plant.set_failure(MachineToolFailure::pocket_pulse_lost, true);
    rig.run_for(duration);
    rig.plant.set_failure(MachineToolFailure::pocket_pulse_lost, false);
  }

  static constexpr int start_tool = 2;
  MachineToolRig rig{machine_tool_program()};
  const std::chrono::milliseconds after{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(after_millis, MachineToolMagazine, ::testing::Range(0, 1700, 50));

TEST_P(MachineToolMagazine, counts_no_pulse_twice_that_was_gone_for_a_moment) {
  change_to(5, after, [&] { lose_pulses_for(50ms); });
}

TEST_P(MachineToolMagazine, misses_no_pulse) {
  change_to(5, after, [&] { lose_pulses_for(700ms); });
}

TEST_P(MachineToolMagazine, misses_no_pulse_while_it_starts_without_one) {
  rig.plant.set_failure(MachineToolFailure::pocket_pulse_lost, true);
  rig.run_for(800ms);
  change_to(5, after, [&] { lose_pulses_for(10ms); });
}

struct MachineToolLateScan : MachineToolMagazine {};
INSTANTIATE_TEST_SUITE_P(after_millis, MachineToolLateScan, ::testing::Range(400, 700, 10));

TEST_P(MachineToolLateScan, is_within_the_watchdog_and_misleads_no_magazine) {
  change_to(1, 100ms, [&] {
    rig.now += 6ms;  // pockets do not pass at the time of a scan
    rig.run_for(after);
    rig.now += 200ms;
  });
}

}  // namespace
}  // namespace emulator_models
