// The machine behind the terminals, without a PLC.
#include "emulator_models/machine_plant.hpp"

#include <gtest/gtest.h>

#include "emulator_models/machine_devices.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;

struct MachinePlantTest : ::testing::Test {
  MachinePlant plant;
  Terminals terminals;
  SteadyTime now{1h};

  void after(std::chrono::nanoseconds pause) {
    now += pause;
    plant.advance(terminals, now);
  }
  void order(machine::Device output, bool on) { terminals.outputs.set(output.number, on); }
  [[nodiscard]] bool sees(machine::Device input) const { return terminals.inputs.test(input.number); }
};

TEST_F(MachinePlantTest, the_machine_stands_with_the_door_closed_at_first) {
  after(0ms);
  EXPECT_TRUE(sees(machine::zero_speed_switch));
  EXPECT_TRUE(sees(machine::door_switch));
  EXPECT_TRUE(sees(machine::emergency_stop_chain));
  EXPECT_FALSE(sees(machine::at_speed_switch));
}

TEST_F(MachinePlantTest, the_spindle_is_at_speed_after_its_time_and_not_a_nanosecond_before) {
  order(machine::spindle_clockwise, true);
  after(0ms);
  EXPECT_FALSE(sees(machine::zero_speed_switch));
  after(500ms - 1ns);
  EXPECT_FALSE(sees(machine::at_speed_switch));
  after(1ns);
  EXPECT_TRUE(sees(machine::at_speed_switch));
}

TEST_F(MachinePlantTest, the_spindle_stands_after_its_time) {
  order(machine::spindle_counter_clockwise, true);
  after(0ms);
  after(1s);
  order(machine::spindle_counter_clockwise, false);
  after(10ms);
  EXPECT_FALSE(sees(machine::at_speed_switch) || sees(machine::zero_speed_switch));
  after(500ms);
  EXPECT_TRUE(sees(machine::zero_speed_switch));
}

TEST_F(MachinePlantTest, another_speed_is_another_run_up_but_not_for_a_spindle_that_stands) {
  terminals.analog_outputs[0] = 500;
  after(10ms);
  EXPECT_TRUE(sees(machine::zero_speed_switch));
  order(machine::spindle_clockwise, true);
  after(10ms);
  after(500ms);
  EXPECT_TRUE(sees(machine::at_speed_switch));
  terminals.analog_outputs[0] = 800;
  after(10ms);
  EXPECT_FALSE(sees(machine::at_speed_switch));
  after(500ms);
  EXPECT_TRUE(sees(machine::at_speed_switch));
}

TEST_F(MachinePlantTest, both_directions_together_are_neither_at_speed_nor_standing) {
  order(machine::spindle_clockwise, true);
  order(machine::spindle_counter_clockwise, true);
  after(10ms);
  after(10s);
  EXPECT_FALSE(sees(machine::at_speed_switch) || sees(machine::zero_speed_switch));
}

TEST_F(MachinePlantTest, coolant_flows_after_its_time_and_stops_with_its_valve) {
  order(machine::flood_coolant, true);
  after(0ms);
  after(300ms - 1ns);
  EXPECT_FALSE(sees(machine::flood_flow_switch));
  after(1ns);
  EXPECT_TRUE(sees(machine::flood_flow_switch));
  EXPECT_FALSE(sees(machine::mist_flow_switch));
  order(machine::flood_coolant, false);
  after(0ms);
  EXPECT_FALSE(sees(machine::flood_flow_switch));
}

TEST_F(MachinePlantTest, a_blocked_pipe_shows_no_flow) {
  plant.set_coolant_blocked(true);
  order(machine::mist_coolant, true);
  after(0ms);
  after(1min);
  EXPECT_FALSE(sees(machine::mist_flow_switch));
}

TEST_F(MachinePlantTest, the_tool_changes_only_with_the_clamp_released) {
  order(machine::tool_magazine, true);
  after(0ms);
  after(2s);
  EXPECT_FALSE(sees(machine::tool_changed_switch));
  order(machine::tool_clamp_release, true);
  after(0ms);
  after(1200ms);
  EXPECT_TRUE(sees(machine::tool_changed_switch));
}

}  // namespace
}  // namespace emulator_models
