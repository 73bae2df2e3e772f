// The units of the machine tool, without a PLC.
#include "emulator_models/plants/machine_tool_plant.hpp"

#include <gtest/gtest.h>

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using machine_tool::X;
using machine_tool::Y;

struct MachineToolPlantTest : ::testing::Test {
  MachineToolPlant plant;
  Terminals terminals;
  SteadyTime now{1h};

  MachineToolPlantTest() {
    order(Y::contactor, true);
    after(0ms);
    after(50ms);
  }
  void after(std::chrono::nanoseconds pause) {
    now += pause;
    plant.advance(terminals, now);
  }
  void order(Y output, bool on) { terminals.outputs.set(index_of(output), on); }
  [[nodiscard]] bool sees(X input) const { return terminals.inputs.test(index_of(input)); }
};

TEST_F(MachineToolPlantTest, the_spindle_runs_up_whatever_the_number_of_calls) {
  terminals.analog_outputs[0] = 3000;
  order(Y::spindle_clockwise, true);
  after(0ms);
  MachineToolPlant other = plant;
  Terminals other_terminals = terminals;
  for (int i = 0; i < 600; ++i) after(1ms);
  other.advance(other_terminals, now);
  EXPECT_EQ(plant.spindle().speed_rpm(), other.spindle().speed_rpm());
  EXPECT_FALSE(sees(X::spindle_at_speed));
  after(100ms);
  EXPECT_TRUE(sees(X::spindle_at_speed));
}

TEST_F(MachineToolPlantTest, both_directions_and_a_reversal_under_way_are_drive_faults) {
  terminals.analog_outputs[0] = 3000;
  order(Y::spindle_clockwise, true);
  after(0ms);
  after(1s);
  order(Y::spindle_clockwise, false);
  order(Y::spindle_counter_clockwise, true);
  after(10ms);
  EXPECT_TRUE(sees(X::spindle_drive_fault));
}

TEST_F(MachineToolPlantTest, coolant_flows_after_its_time_and_not_a_nanosecond_before) {
  order(Y::flood_pump, true);
  after(0ms);
  after(500ms - 1ns);
  EXPECT_FALSE(sees(X::flood_flow));
  after(1ns);
  EXPECT_TRUE(sees(X::flood_flow));
}

TEST_F(MachineToolPlantTest, a_pocket_takes_800_ms) {
  order(Y::magazine_clockwise, true);
  after(0ms);
  after(700ms - 1ns);
  EXPECT_FALSE(sees(X::pocket_pulse));
  after(1ns);
  EXPECT_TRUE(sees(X::pocket_pulse));
  EXPECT_EQ(plant.changer().pocket_at_change(), 2U);
}

TEST_F(MachineToolPlantTest, an_exchange_with_the_tool_clamped_jams_the_arm) {
  order(Y::arm_grip, true);
  after(0ms);
  after(1s);
  order(Y::arm_exchange, true);
  after(10ms);
  EXPECT_TRUE(sees(X::magazine_motor_overload));
  after(5s);
  EXPECT_EQ(plant.changer().tool_in_spindle(), 0);
}

TEST_F(MachineToolPlantTest, the_chuck_moves_under_pressure_only) {
  order(Y::chuck_unclamp, true);
  after(0ms);
  after(5s);
  EXPECT_TRUE(sees(X::chuck_clamped));
  order(Y::hydraulic_pump, true);
  after(0ms);
  after(1500ms);
  EXPECT_TRUE(sees(X::hydraulic_pressure));
  after(400ms);
  EXPECT_TRUE(sees(X::chuck_unclamped));
}

TEST_F(MachineToolPlantTest, a_door_is_locked_without_current_and_then_stays_closed) {
  after(0ms);
  after(100ms);
  EXPECT_TRUE(sees(X::door_locked));
  plant.set_door_pulled_open(true);
  after(1s);
  EXPECT_TRUE(sees(X::door_closed));
  order(Y::door_unlock, true);
  after(0ms);
  after(100ms);
  EXPECT_FALSE(sees(X::door_closed));
}

TEST_F(MachineToolPlantTest, an_open_contact_takes_the_power_whatever_the_plc_does) {
  order(Y::flood_pump, true);
  after(0ms);
  after(1s);
  plant.set_emergency_stop_pressed(true);
  after(0ms);
  EXPECT_FALSE(sees(X::flood_flow) || sees(X::contactor_on) || sees(X::chain_closed));
}

TEST_F(MachineToolPlantTest, switches_can_stick) {
  plant.set_stuck_on(X::flood_flow, true);
  plant.set_stuck_off(X::door_closed, true);
  after(0ms);
  EXPECT_TRUE(sees(X::flood_flow));
  EXPECT_FALSE(sees(X::door_closed));
}

}  // namespace
}  // namespace emulator_models
