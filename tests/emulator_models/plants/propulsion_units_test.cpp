// Oil pumps, control lever and shaft, each alone.
#include <gtest/gtest.h>

#include "emulator_models/plants/control_lever.hpp"
#include "emulator_models/plants/lubricating_oil.hpp"
#include "emulator_models/plants/propulsion_shaft.hpp"

namespace emulator_models::propulsion {
namespace {

using namespace std::chrono_literals;

TEST(LubricatingOil, pressure_is_there_after_2_s_and_not_a_nanosecond_before) {
  LubricatingOil oil;
  oil.order(0, true);
  oil.pass(2s - 1ns);
  EXPECT_FALSE(oil.pressure_switch_closed());
  oil.pass(1ns);
  EXPECT_TRUE(oil.pressure_switch_closed());
}

TEST(LubricatingOil, the_switch_opens_below_half_of_the_pressure) {
  LubricatingOil oil;
  oil.order(1, true);
  oil.pass(5s);
  oil.order(1, false);
  oil.pass(500ms);
  EXPECT_TRUE(oil.pressure_switch_closed());
  oil.pass(1ns);
  EXPECT_FALSE(oil.pressure_switch_closed());
}

TEST(LubricatingOil, one_pump_holds_the_pressure_of_two) {
  LubricatingOil oil;
  oil.order(0, true);
  oil.order(1, true);
  oil.pass(2s);
  oil.set_without_pressure(0, true);
  oil.pass(1h);
  EXPECT_TRUE(oil.has_pressure());
  oil.set_without_pressure(1, true);
  oil.pass(1s);
  EXPECT_FALSE(oil.has_pressure());
}

TEST(LubricatingOil, an_overloaded_pump_does_not_run_and_a_dry_one_does) {
  LubricatingOil oil;
  oil.order(0, true);
  oil.order(1, true);
  oil.set_overloaded(0, true);
  oil.set_without_pressure(1, true);
  EXPECT_FALSE(oil.runs(0));
  EXPECT_FALSE(oil.protection_closed(0));
  EXPECT_TRUE(oil.runs(1));
  oil.pass(1min);
  EXPECT_FALSE(oil.has_pressure());
  oil.set_overloaded(0, false);
  oil.pass(2s);
  EXPECT_TRUE(oil.has_pressure());
}

TEST(LubricatingOil, a_stuck_switch_hides_the_truth) {
  LubricatingOil oil;
  oil.set_switch_stuck_closed(true);
  EXPECT_TRUE(oil.pressure_switch_closed());
  EXPECT_FALSE(oil.has_pressure());
  oil.set_switch_stuck_open(true);
  oil.order(0, true);
  oil.pass(3s);
  EXPECT_FALSE(oil.pressure_switch_closed());
  EXPECT_TRUE(oil.has_pressure());
}

TEST(ControlLever, the_word_is_4_to_20_mA) {
  ControlLever lever;
  EXPECT_EQ(lever.word(), 1200);
  lever.move_to(-1000);
  EXPECT_EQ(lever.word(), 400);
  lever.move_to(1500);
  EXPECT_EQ(lever.word(), 2000);
  EXPECT_EQ(lever.position_permille(), 1000);
}

TEST(ControlLever, the_switches_change_over_at_2_percent) {
  ControlLever lever;
  lever.move_to(20);
  EXPECT_TRUE(lever.stop_closed());
  EXPECT_FALSE(lever.ahead_closed());
  lever.move_to(21);
  EXPECT_FALSE(lever.stop_closed());
  EXPECT_TRUE(lever.ahead_closed());
  lever.move_to(-21);
  EXPECT_FALSE(lever.stop_closed() || lever.ahead_closed());
  EXPECT_TRUE(lever.astern_closed());
}

TEST(ControlLever, the_servo_takes_4_s_from_end_to_end_and_is_stronger_than_a_hand) {
  ControlLever lever;
  lever.move_to(-1000);
  lever.order_servo(true, 2000);
  lever.pass(2s);
  EXPECT_EQ(lever.position_permille(), 0);
  lever.move_to(-500);
  lever.pass(2s - 1ns);
  EXPECT_EQ(lever.position_permille(), 999);
  lever.pass(1ns);
  EXPECT_EQ(lever.position_permille(), 1000);
  lever.order_servo(true, 0);
  lever.set_servo_jammed(true);
  lever.pass(1min);
  EXPECT_EQ(lever.position_permille(), 1000);
}

TEST(ControlLever, its_failures_show_in_the_word_and_the_switches) {
  ControlLever lever;
  lever.set_noisy(true);
  lever.pass(1ms);
  EXPECT_EQ(lever.word(), 1210);
  lever.pass(1ms);
  EXPECT_EQ(lever.word(), 1190);
  lever.set_short_circuit(true);
  EXPECT_EQ(lever.word(), ControlLever::short_circuit_word);
  lever.set_wire_broken(true);
  EXPECT_EQ(lever.word(), ControlLever::broken_wire_word);
  lever.set_stop_switch(ControlLever::Switch::stuck_open);
  EXPECT_FALSE(lever.stop_closed());
}

TEST(PropulsionShaft, the_speed_follows_the_order_less_the_load_of_the_sea) {
  PropulsionShaft shaft;
  shaft.order(true, 1000);
  for (int i = 0; i < 400; ++i) shaft.pass(10ms);
  EXPECT_NEAR(shaft.speed_permille(), 900 * (1 - 0.3679), 3) << "one time constant";
  for (int i = 0; i < 4000; ++i) shaft.pass(10ms);
  EXPECT_EQ(shaft.speed_permille(), 900);
  shaft.set_sea_load(500);
  for (int i = 0; i < 4000; ++i) shaft.pass(10ms);
  EXPECT_EQ(shaft.speed_permille(), 500);
}

TEST(PropulsionShaft, the_order_is_limited_and_signed_and_counts_only_when_enabled) {
  PropulsionShaft shaft;
  shaft.order(true, static_cast<std::uint16_t>(-30000));
  shaft.pass(24h);
  EXPECT_EQ(shaft.speed_permille(), -900);
  EXPECT_EQ(shaft.speed_word(), static_cast<std::uint16_t>(-900));
  shaft.order(false, 1000);
  shaft.pass(24h);
  EXPECT_EQ(shaft.speed_permille(), 0);
}

TEST(PropulsionShaft, blocked_it_stands_and_a_broken_sensor_shows_what_no_speed_is) {
  PropulsionShaft shaft;
  shaft.order(true, 1000);
  shaft.pass(1h);
  shaft.set_blocked(true);
  shaft.pass(1ms);
  EXPECT_EQ(shaft.speed_permille(), 0);
  shaft.set_sensor_broken(true);
  EXPECT_EQ(shaft.speed_word(), PropulsionShaft::broken_sensor_word);
}

}  // namespace
}  // namespace emulator_models::propulsion
