// Program and plant together, over simulated scans: start, low oil, change-over, lever, lost link, speed.
#include "emulator_models/programs/propulsion_program.hpp"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"
#include "tests/emulator_models/plants/propulsion_rig.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using enum PropulsionFailure;
namespace wire = propulsion;

struct PropulsionProgramTest : ::testing::Test {
  PropulsionRig rig;

  void lose_both_pumps() {
    rig.start();
    rig.plant.move_lever(800);
    rig.scan_for(15s);
    rig.fail(pump_1_without_pressure);
    rig.fail(pump_2_without_pressure);
    while (rig.in(wire::oil_pressure)) rig.scan();
  }
  void TearDown() override { EXPECT_EQ(rig.broken_rules(), ""); }
};

TEST(PropulsionProgram, its_addresses_are_those_of_the_wiring) {
  const FxAddressMap map{protocol::fx::Model::fx3u};
  const auto program = soft_plc::compile(propulsion_program(), map);
  ASSERT_TRUE(program.has_value()) << to_string(program.error());
  EXPECT_TRUE(program->warnings.empty());
  const auto expect_at = [&](const char* name, wire::Device device) {
    const soft_plc::IlVariable* variable = program->find(name);
    ASSERT_NE(variable, nullptr) << name;
    const auto place = map.device(to_string(device), variable->type);
    ASSERT_TRUE(place.has_value()) << name << ": " << place.error();
    EXPECT_EQ(variable->area, place->area) << name;
    EXPECT_EQ(variable->offset, place->offset) << name;
    EXPECT_EQ(variable->bit_index, place->bit_index) << name;
  };
  expect_at("LEVER_ASTERN", wire::lever_astern);
  expect_at("PUMP_2_PROTECTION", wire::pump_2_protection);
  expect_at("ACKNOWLEDGE_BUTTON", wire::acknowledge_button);
  expect_at("PUMPS_SWITCH", wire::pumps_switch);
  expect_at("RUN", wire::run);
  expect_at("LEVER_SERVO", wire::lever_servo);
  expect_at("LIMIT_LAMP", wire::limit_lamp);
  expect_at("PC_PUMPS", wire::pc_pumps);
  expect_at("TRIPPED", wire::tripped);
  expect_at("OIL_ALARM", wire::oil_alarm);
  expect_at("SPEED_ALARM", wire::speed_alarm);
  expect_at("PC_ORDER", wire::pc_order);
  expect_at("HEARTBEAT", wire::heartbeat);
  expect_at("UNLIMITED", wire::unlimited);
  expect_at("SPEED_WORD", wire::speed_word);
  expect_at("LEVER_ORDER_WORD", wire::lever_order_word);
}

TEST_F(PropulsionProgramTest, starts_with_oil_pressure_and_follows_the_lever) {
  rig.start();
  EXPECT_TRUE(rig.out(wire::run) && rig.out(wire::run_lamp) && rig.on(wire::running));
  rig.plant.move_lever(600);
  rig.scan_for(60s);
  EXPECT_NEAR(rig.plant.shaft_permille(), 600, 5);
  rig.plant.move_lever(-400);
  rig.scan_for(60s);
  EXPECT_NEAR(rig.plant.shaft_permille(), -400, 5);
}

TEST_F(PropulsionProgramTest, low_oil_is_buzzer_at_once_limit_after_5_s_stop_after_10_s) {
  lose_both_pumps();
  EXPECT_TRUE(rig.out(wire::buzzer) && rig.out(wire::oil_lamp));
  rig.scan_for(4990ms);
  EXPECT_FALSE(rig.out(wire::limit_lamp));
  EXPECT_NEAR(rig.word(wire::setpoint), 800, 2);
  rig.scan_for(110ms);
  EXPECT_TRUE(rig.out(wire::limit_lamp));
  EXPECT_EQ(rig.word(wire::setpoint), 400);
  rig.scan_for(4890ms);
  EXPECT_TRUE(rig.out(wire::run));
  rig.scan();
  EXPECT_FALSE(rig.out(wire::run));
  EXPECT_TRUE(rig.on(wire::tripped));
}

TEST_F(PropulsionProgramTest, acknowledge_stops_the_buzzer_and_the_lamp_stays_until_the_cause_is_gone) {
  lose_both_pumps();
  rig.press_acknowledge();
  EXPECT_FALSE(rig.out(wire::buzzer));
  rig.scan_for(2s);
  EXPECT_TRUE(rig.out(wire::oil_lamp));
  rig.fail(pump_1_without_pressure, false);
  rig.fail(pump_2_without_pressure, false);
  rig.scan_for(2500ms);
  EXPECT_FALSE(rig.out(wire::oil_lamp));
}

TEST_F(PropulsionProgramTest, after_a_trip_it_starts_again_only_when_acknowledged_with_the_cause_gone) {
  lose_both_pumps();
  rig.scan_for(11s);
  rig.plant.move_lever(0);
  rig.press_acknowledge();
  rig.scan_for(1s);
  EXPECT_TRUE(rig.on(wire::tripped)) << "no pressure yet";
  rig.fail(pump_1_without_pressure, false);
  rig.fail(pump_2_without_pressure, false);
  rig.scan_for(3s);
  rig.press_start();
  EXPECT_FALSE(rig.out(wire::run));
  rig.press_acknowledge();
  rig.scan();
  rig.press_start();
  EXPECT_TRUE(rig.out(wire::run));
}

TEST_F(PropulsionProgramTest, a_trip_outlasts_a_stop_of_the_plc) {
  lose_both_pumps();
  rig.scan_for(11s);
  rig.fail(pump_1_without_pressure, false);
  rig.fail(pump_2_without_pressure, false);
  rig.plant.move_lever(0);
  rig.stop_and_run_plc();
  rig.scan_for(3s);
  EXPECT_TRUE(rig.on(wire::tripped));
  rig.press_start();
  EXPECT_FALSE(rig.out(wire::run));
  rig.press_acknowledge();
  rig.scan();
  rig.press_start();
  EXPECT_TRUE(rig.out(wire::run));
}

TEST_F(PropulsionProgramTest, the_standby_pump_takes_over_before_the_speed_is_limited) {
  rig.start();
  rig.fail(pump_1_without_pressure);
  rig.scan_for(6s);
  EXPECT_FALSE(rig.out(wire::pump_1));
  EXPECT_TRUE(rig.out(wire::pump_2) && rig.on(wire::pump_1_alarm) && rig.out(wire::pump_lamp));
  EXPECT_TRUE(rig.out(wire::run) && rig.in(wire::oil_pressure));
  EXPECT_FALSE(rig.on(wire::speed_limited));
}

TEST_F(PropulsionProgramTest, the_station_chooses_the_duty_pump_and_an_overload_changes_over_at_once) {
  rig.set(wire::duty_is_pump_2, true);
  rig.set(wire::pc_pumps, true);
  rig.scan_for(3s);
  EXPECT_TRUE(rig.out(wire::pump_2) && !rig.out(wire::pump_1));
  rig.fail(pump_2_overload);
  rig.scan();
  EXPECT_TRUE(rig.out(wire::pump_1) && !rig.out(wire::pump_2));
  EXPECT_EQ(rig.word(wire::alarm_number), 3);
}

TEST_F(PropulsionProgramTest, a_stuck_pressure_switch_is_an_alarm_and_no_start) {
  rig.fail(pressure_switch_stuck_closed);
  rig.scan_for(5s);
  EXPECT_FALSE(rig.on(wire::switch_alarm));
  rig.scan_for(50ms);
  EXPECT_TRUE(rig.on(wire::switch_alarm) && rig.out(wire::buzzer));
  rig.press_start();
  EXPECT_FALSE(rig.out(wire::run));
}

TEST_F(PropulsionProgramTest, a_broken_lever_wire_holds_the_speed_and_is_an_alarm) {
  rig.start();
  rig.plant.move_lever(500);
  rig.scan_for(20s);
  for (const PropulsionFailure failure : {lever_wire_broken, lever_short_circuit}) {
    rig.fail(failure);
    rig.scan_for(5s);
    EXPECT_EQ(rig.word(wire::target), 500);
    EXPECT_TRUE(rig.out(wire::lever_lamp));
    rig.fail(failure, false);
    rig.scan_for(1s);
    EXPECT_FALSE(rig.out(wire::lever_lamp));
  }
}

TEST_F(PropulsionProgramTest, the_mean_of_8_samples_hides_the_noise_of_the_lever) {
  rig.plant.move_lever(500);
  rig.fail(lever_noise);
  rig.scan_for(1s);
  EXPECT_EQ(rig.word(wire::lever), 500);
}

TEST_F(PropulsionProgramTest, after_full_ahead_against_a_heavy_sea_nothing_stored_up_delays_the_way_down) {
  rig.start();
  rig.plant.set_sea_load(300);
  rig.plant.move_lever(1000);
  rig.scan_for(60s);
  EXPECT_EQ(rig.word(wire::torque), 1000) << "in saturation";
  rig.plant.set_sea_load(100);
  rig.plant.move_lever(500);
  int lowest = 1000;
  for (int i = 0; i < 4000; ++i) {
    rig.scan();
    lowest = std::min(lowest, rig.plant.shaft_permille());
  }
  EXPECT_NEAR(rig.plant.shaft_permille(), 500, 5);
  EXPECT_GT(lowest, 440);
}

TEST_F(PropulsionProgramTest, without_a_speed_sensor_the_order_is_the_torque) {
  rig.start();
  rig.fail(speed_sensor_broken);
  rig.plant.move_lever(500);
  rig.scan_for(30s);
  EXPECT_TRUE(rig.on(wire::speed_alarm));
  EXPECT_NEAR(rig.word(wire::torque), 500, 60);
  EXPECT_TRUE(rig.out(wire::run));
}

TEST_F(PropulsionProgramTest, a_blocked_shaft_stops_the_engine_and_does_not_run_after_repair_by_itself) {
  rig.start();
  rig.plant.move_lever(900);
  rig.fail(shaft_blocked);
  rig.scan_for(12s);
  EXPECT_FALSE(rig.out(wire::run));
  EXPECT_EQ(rig.word(wire::alarm_number), 6);
  rig.fail(shaft_blocked, false);
  rig.plant.move_lever(0);
  rig.scan_for(5s);
  EXPECT_FALSE(rig.out(wire::run));
  rig.press_acknowledge();
  rig.scan();
  rig.press_start();
  EXPECT_TRUE(rig.out(wire::run));
}

TEST_F(PropulsionProgramTest, the_station_orders_the_speed_and_the_lever_follows) {
  rig.start();
  rig.give_control_to_station();
  rig.set_word(wire::pc_order, 500);
  rig.scan_for(30s);
  EXPECT_NEAR(rig.plant.shaft_permille(), 500, 5);
  EXPECT_EQ(rig.plant.lever_permille(), 500);
  rig.plant.set_local_switch(true);
  rig.scan_for(1s);
  EXPECT_EQ(rig.word(wire::target), 500) << "no jump";
  EXPECT_TRUE(rig.out(wire::local_lamp));
}

TEST_F(PropulsionProgramTest, a_lost_link_holds_the_order_gives_an_alarm_and_leaves_control_to_the_lever) {
  rig.start();
  rig.give_control_to_station();
  rig.set_word(wire::pc_order, 500);
  rig.scan_for(30s);
  rig.heartbeat = false;
  rig.scan_for(2010ms);
  EXPECT_TRUE(rig.on(wire::link_lost));
  rig.set_word(wire::pc_order, -900);
  rig.scan_for(4980ms);
  EXPECT_FALSE(rig.on(wire::link_alarm));
  rig.scan_for(20ms);
  EXPECT_TRUE(rig.on(wire::link_alarm) && rig.out(wire::buzzer) && rig.out(wire::link_lamp));
  rig.scan_for(60s);
  EXPECT_EQ(rig.word(wire::target), 500);
  rig.plant.move_lever(300);
  rig.scan_for(1s);
  EXPECT_EQ(rig.word(wire::target), 300);
  rig.heartbeat = true;
  rig.scan_for(1s);
  EXPECT_FALSE(rig.out(wire::link_lamp));
  EXPECT_EQ(rig.word(wire::target), 300) << "not without a new order of control";
  rig.set(wire::pc_remote, false);
  rig.scan();
  rig.give_control_to_station();
  EXPECT_EQ(rig.word(wire::target), -900);
}

}  // namespace
}  // namespace emulator_models
