// The units behind the terminals: wiring, failures, time.
#include "emulator_models/plants/propulsion_plant.hpp"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "emulator_models/plants/propulsion_devices.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using enum PropulsionFailure;
namespace wire = propulsion;

struct PropulsionPlantTest : ::testing::Test {
  PropulsionPlant plant;
  Terminals terminals;
  SteadyTime now{1h};

  void after(std::chrono::nanoseconds pause) {
    now += pause;
    plant.advance(terminals, now);
  }
  void order(wire::Device output, bool on = true) { terminals.outputs.set(output.number, on); }
  [[nodiscard]] bool sees(wire::Device input) const { return terminals.inputs.test(input.number); }
};

TEST_F(PropulsionPlantTest, at_first_all_rests_and_what_opens_in_trouble_is_closed) {
  after(0ms);
  EXPECT_TRUE(sees(wire::lever_stop) && sees(wire::stop_button));
  EXPECT_TRUE(sees(wire::pump_1_protection) && sees(wire::pump_2_protection));
  EXPECT_EQ(terminals.inputs.count(), 4U);
  EXPECT_EQ(terminals.analog_inputs[wire::lever_input], 1200);
  EXPECT_EQ(terminals.analog_inputs[wire::speed_input], 0);
}

TEST_F(PropulsionPlantTest, an_output_counts_from_the_call_that_sees_it) {
  after(0ms);
  order(wire::pump_2);
  after(1h);
  EXPECT_TRUE(sees(wire::pump_2_runs));
  EXPECT_FALSE(sees(wire::oil_pressure));
  after(2s);
  EXPECT_TRUE(sees(wire::oil_pressure));
}

TEST_F(PropulsionPlantTest, a_time_that_goes_back_changes_nothing) {
  order(wire::pump_1);
  after(0ms);
  after(1s);
  after(-1h);
  now += 1h;
  after(1s);
  EXPECT_TRUE(sees(wire::oil_pressure));
}

TEST_F(PropulsionPlantTest, each_hand_is_on_its_wire) {
  plant.press_acknowledge(true);
  plant.press_start(true);
  plant.press_stop(true);
  plant.set_local_switch(true);
  plant.set_pumps_switch(true);
  plant.move_lever(-500);
  after(0ms);
  for (const wire::Device input : {wire::acknowledge_button, wire::start_button, wire::local_switch,
                                   wire::pumps_switch, wire::lever_astern})
    EXPECT_TRUE(sees(input)) << input.number;
  EXPECT_FALSE(sees(wire::stop_button));
  EXPECT_EQ(terminals.analog_inputs[wire::lever_input], 800);
}

TEST_F(PropulsionPlantTest, every_failure_shows_and_goes_without_a_trace) {
  const auto inputs_with = [](std::optional<PropulsionFailure> failure, bool repaired) {
    PropulsionPlant tested;
    Terminals wires;
    for (const wire::Device output : {wire::pump_1, wire::pump_2, wire::run, wire::lever_servo})
      wires.outputs.set(output.number);
    // A rest of both pumps in the middle shows a switch that sticks.
    std::vector<bool> seen;
    if (failure) tested.set_failure(*failure, true);
    if (failure && repaired) tested.set_failure(*failure, false);
    for (int second = 0; second < 12; ++second) {
      const bool only_first = second < 4;
      wires.outputs.set(wire::pump_1.number, only_first);
      wires.outputs.set(wire::pump_2.number, second >= 8);
      wires.analog_outputs = {800, static_cast<std::uint16_t>(second < 4 ? 1600 : second < 8 ? 1200 : 800)};
      for (int i = 0; i < 100; ++i)
        tested.advance(wires, SteadyTime{std::chrono::seconds{second} + i * 10ms});
      for (std::size_t i = 0; i < 16; ++i) seen.push_back(wires.inputs[i]);
      for (const std::uint16_t word : wires.analog_inputs)
        for (int bit = 0; bit < 16; ++bit) seen.push_back((word >> bit & 1) != 0);
    }
    return seen;
  };
  const auto sound = inputs_with(std::nullopt, false);
  for (std::size_t i = 0; i < propulsion_failures_count; ++i) {
    const auto failure = static_cast<PropulsionFailure>(i);
    EXPECT_NE(inputs_with(failure, false), sound) << i;
    EXPECT_EQ(inputs_with(failure, true), sound) << i;
  }
}

}  // namespace
}  // namespace emulator_models
