// Each interlock rule: in a situation that puts it to the test, the whole program breaks no rule, and the
// program without the lines of the rule breaks just that rule, by name.
#include "emulator_models/plants/propulsion_rules.hpp"

#include <gtest/gtest.h>

#include "emulator_models/programs/propulsion_program.hpp"
#include "tests/emulator_models/plants/propulsion_rig.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using enum PropulsionFailure;
namespace wire = propulsion;

struct RuleCase {
  PropulsionRule rule;
  void (*situation)(PropulsionRig&);
  /// What cannot be kept without the rule, as broken_rules() says it.
  const char* consequences = "";
};

void run_at_full_lever(PropulsionRig& rig) {
  rig.start();
  rig.plant.move_lever(1000);
  rig.scan_for(15s);
}

void lose_oil(PropulsionRig& rig) {
  run_at_full_lever(rig);
  rig.fail(pump_1_without_pressure);
  rig.fail(pump_2_without_pressure);
  rig.scan_for(12s);
}

void lose_link(PropulsionRig& rig) {
  rig.start();
  rig.give_control_to_station();
  rig.set_word(wire::pc_order, 500);
  rig.scan_for(8s);
  rig.heartbeat = false;
  rig.scan_for(3s);
  rig.set_word(wire::pc_order, 900);
  rig.scan_for(5s);
}

const RuleCase cases[] = {
    {PropulsionRule::ahead_switch,
     [](PropulsionRig& rig) {
       rig.fail(ahead_switch_stuck_open);
       run_at_full_lever(rig);
     }},
    {PropulsionRule::anti_windup, run_at_full_lever},
    {PropulsionRule::astern_switch,
     [](PropulsionRig& rig) {
       rig.fail(astern_switch_stuck_open);
       rig.start();
       rig.plant.move_lever(-600);
       rig.scan_for(2s);
     }},
    {PropulsionRule::buzzer_ack,
     [](PropulsionRig& rig) {
       rig.start();
       rig.fail(lever_wire_broken);
       rig.scan_for(1s);
       rig.press_acknowledge();
     }},
    {PropulsionRule::dead_band,
     [](PropulsionRig& rig) {
       rig.plant.move_lever(27);
       rig.scan_for(1s);
     }},
    {PropulsionRule::lever_range,
     [](PropulsionRig& rig) {
       run_at_full_lever(rig);
       rig.fail(lever_wire_broken);
       rig.scan_for(1s);
     }},
    {PropulsionRule::link_alarm, lose_link},
    {PropulsionRule::link_hold, lose_link},
    {PropulsionRule::local_control,
     [](PropulsionRig& rig) {
       rig.give_control_to_station();
       rig.scan_for(1s);
       rig.plant.set_local_switch(true);
       rig.scan_for(1s);
     }},
    {PropulsionRule::oil_after_run,
     [](PropulsionRig& rig) {
       rig.start();
       rig.plant.set_pumps_switch(false);
       rig.scan_for(1s);
       rig.plant.press_stop(true);
       rig.scan_for(32s);
     }},
    {PropulsionRule::oil_buzzer, lose_oil},
    {PropulsionRule::oil_lamp, lose_oil},
    {PropulsionRule::oil_speed_limit, lose_oil},
    {PropulsionRule::oil_start,
     [](PropulsionRig& rig) {
       rig.scan_for(100ms);
       rig.press_start();
     }},
    {PropulsionRule::oil_stop, lose_oil},
    {PropulsionRule::order_limit,
     [](PropulsionRig& rig) {
       rig.give_control_to_station();
       rig.set_word(wire::pc_order, 3000);
       rig.scan();
     }},
    {PropulsionRule::pump_1_protection,
     [](PropulsionRig& rig) {
       rig.start();
       rig.fail(pump_1_overload);
       rig.fail(pump_2_overload);
       rig.scan();
       rig.set(wire::duty_is_pump_2, true);
       rig.scan_for(1s);
     }},
    {PropulsionRule::pump_2_protection,
     [](PropulsionRig& rig) {
       rig.set(wire::duty_is_pump_2, true);
       rig.start();
       rig.fail(pump_1_overload);
       rig.fail(pump_2_overload);
       rig.scan();
       rig.set(wire::duty_is_pump_2, false);
       rig.scan_for(1s);
     }},
    {PropulsionRule::ramp, run_at_full_lever},
    {PropulsionRule::remote_return,
     [](PropulsionRig& rig) {
       rig.give_control_to_station();
       rig.plant.set_local_switch(true);
       rig.scan_for(1s);
       rig.plant.set_local_switch(false);
       rig.scan_for(1s);
     }},
    {PropulsionRule::shaft_blocked,
     [](PropulsionRig& rig) {
       run_at_full_lever(rig);
       rig.fail(shaft_blocked);
       rig.scan_for(7s);
     }},
    {PropulsionRule::standby_pump,
     [](PropulsionRig& rig) {
       rig.fail(pump_1_without_pressure);
       rig.plant.set_pumps_switch(true);
       rig.scan_for(3s);
     }},
    {PropulsionRule::start_at_zero,
     [](PropulsionRig& rig) {
       rig.plant.move_lever(500);
       rig.start();
     }},
    {PropulsionRule::start_edge,
     [](PropulsionRig& rig) {
       rig.start();
       rig.plant.press_start(true);
       rig.scan();
       rig.plant.press_stop(true);
       rig.scan();
       rig.plant.press_stop(false);
       rig.scan();
     }},
    {PropulsionRule::station_stop,
     [](PropulsionRig& rig) {
       rig.start();
       rig.set(wire::pc_stop, true);
       rig.scan();
     }},
    {PropulsionRule::stop_button,
     [](PropulsionRig& rig) {
       rig.start();
       rig.plant.press_stop(true);
       rig.scan();
     }},
    {PropulsionRule::stop_switch,
     [](PropulsionRig& rig) {
       rig.fail(stop_switch_stuck_closed);
       run_at_full_lever(rig);
     }},
    {PropulsionRule::switch_proved,
     [](PropulsionRig& rig) {
       rig.fail(pressure_switch_stuck_closed);
       rig.scan_for(1s);
       rig.press_start();
     }},
    {PropulsionRule::take_over,
     [](PropulsionRig& rig) {
       lose_link(rig);
       rig.plant.move_lever(100);
       rig.scan_for(1s);
     }},
    {PropulsionRule::torque_limit, run_at_full_lever, " ANTI_WINDUP"},
    {PropulsionRule::trip_latch,
     [](PropulsionRig& rig) {
       run_at_full_lever(rig);
       rig.fail(shaft_blocked);
       rig.scan_for(6s);
       rig.plant.move_lever(0);
       rig.scan_for(1s);
       rig.press_start();
     }},
};

class PropulsionRuleTest : public ::testing::TestWithParam<RuleCase> {};

TEST_P(PropulsionRuleTest, the_program_keeps_it) {
  PropulsionRig rig;
  GetParam().situation(rig);
  EXPECT_EQ(rig.broken_rules(), "");
}

TEST_P(PropulsionRuleTest, without_its_lines_it_is_named) {
  const std::string name{name_of(GetParam().rule)};
  PropulsionRig rig{name};
  GetParam().situation(rig);
  EXPECT_EQ(rig.broken_rules(), std::string{GetParam().consequences}.append(" ").append(name));
}

INSTANTIATE_TEST_SUITE_P(each, PropulsionRuleTest, ::testing::ValuesIn(cases),
                         [](const auto& tested) { return std::string{name_of(tested.param.rule)}; });

TEST(PropulsionRules, every_rule_has_a_line_and_a_case_and_every_tagged_line_a_rule) {
  ASSERT_EQ(std::size(cases), propulsion_rules_count);
  std::size_t lines_count = 0;
  for (std::size_t i = 0; i < propulsion_rules_count; ++i) {
    EXPECT_EQ(static_cast<std::size_t>(cases[i].rule), i);
    EXPECT_NE(program_without(name_of(cases[i].rule)), program_without("")) << name_of(cases[i].rule);
    lines_count += 1;
  }
  const std::string_view source = propulsion_program();
  std::size_t tags_count = 0;
  for (std::size_t at = source.find("(* rule: "); at != source.npos; at = source.find("(* rule: ", at + 1))
    ++tags_count;
  EXPECT_EQ(tags_count, lines_count) << "one line a rule";
}

}  // namespace
}  // namespace emulator_models
