// Each interlock rule broken once: with the lines of one rule taken out of the program, the observer names that
// rule; with all lines in, the same doings break none.
#include "emulator_models/plants/machine_tool_rules.hpp"

#include <gtest/gtest.h>

#include "emulator_models/programs/interlock_rules.hpp"
#include "emulator_models/programs/machine_tool_program.hpp"
#include "tests/emulator_models/plants/machine_tool_rig.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;

/// What a day of operators and failures can bring, in a few minutes.
void provoke(MachineToolRig& rig) {
  // Before the hydraulics have pressure: two directions one after the other.
  rig.run_for(50ms);
  rig.reset();
  for (const int m_code : {3, 4}) {
    rig.give(m_code);
    rig.run_for(100ms);
    rig.take_back_strobes();
  }
  rig.run_for(13s);
  rig.execute(5);
  // Reversal, chuck and door with a turning spindle, then a tool change from full speed.
  rig.execute(3);
  rig.execute(4);
  rig.plant.set_door_button_pressed(true);
  rig.run_for(200ms);
  rig.plant.set_door_button_pressed(false);
  rig.execute(11);
  rig.reset();
  rig.run_for(3s);
  rig.execute(10);
  rig.execute(3);
  rig.select_tool(1);
  rig.execute(6);
  rig.reset();
  rig.run_for(5s);
  rig.select_tool(6);
  rig.execute(6);
  rig.reset();
  rig.run_for(5s);
  // From full speed with the magazine in position: the empty pocket is the one last used.
  rig.execute(3);
  rig.select_tool(0);
  rig.execute(6);
  rig.reset();
  rig.run_for(5s);
  rig.execute(3);
  rig.select_tool(6);
  rig.execute(6);
  rig.reset();
  rig.run_for(5s);
  // Z away from the change position.
  rig.set_m(107, false);
  rig.select_tool(5);
  rig.execute(6);
  rig.reset();
  rig.set_m(107, true);
  rig.run_for(5s);
  // Coolant: ended by M9, by reset, left without flow.
  rig.execute(8);
  rig.execute(9);
  rig.reset();
  rig.execute(8);
  rig.reset();
  rig.plant.set_failure(MachineToolFailure::flood_without_flow, true);
  rig.execute(8);
  rig.plant.set_failure(MachineToolFailure::flood_without_flow, false);
  rig.reset();
  rig.execute(9);
  rig.reset();
  // A stuck arm.
  rig.plant.set_failure(MachineToolFailure::arm_stuck, true);
  rig.select_tool(2);
  rig.execute(6);
  rig.plant.set_failure(MachineToolFailure::arm_stuck, false);
  rig.reset();
  rig.run_for(5s);
  // An open chuck, an open door.
  rig.execute(11);
  rig.execute(3);
  rig.reset();
  rig.run_for(3s);
  rig.execute(10);
  rig.plant.set_door_button_pressed(true);
  rig.plant.set_door_pulled_open(true);
  rig.run_for(1s);
  rig.execute(3);
  rig.plant.set_door_button_pressed(false);
  rig.plant.set_door_pulled_open(false);
  rig.reset();
  rig.run_for(3s);
  // Emergency stop, released without a reset, then armed while lubrication has no pressure.
  rig.execute(13);
  rig.plant.set_emergency_stop_pressed(true);
  rig.run_for(1s);
  rig.plant.set_emergency_stop_pressed(false);
  rig.run_for(1s);
  rig.plant.set_failure(MachineToolFailure::lubrication_pressure_missing, true);
  rig.reset();
  rig.run_for(14s);
}

struct MachineToolRulesBreak : ::testing::TestWithParam<std::string> {};

TEST_P(MachineToolRulesBreak, by_its_name_when_the_program_is_without_it) {
  MachineToolRig rig{without_rule(machine_tool_program(), GetParam())};
  provoke(rig);
  EXPECT_TRUE(rig.broken.contains(GetParam())) << ::testing::PrintToString(rig.broken);
}

INSTANTIATE_TEST_SUITE_P(all, MachineToolRulesBreak, ::testing::ValuesIn(rules_of(machine_tool_program())),
                         [](const auto& tried) {
                           std::string name = tried.param;
                           for (char& letter : name) letter = letter == '-' ? '_' : letter;
                           return name;
                         });

TEST(MachineToolRules, are_all_kept_by_the_whole_program) {
  for (const auto period : {1ms, 10ms}) {
    MachineToolRig rig{machine_tool_program(), period};
    provoke(rig);
    EXPECT_EQ(rig.broken, std::set<std::string>{}) << period.count();
  }
}

TEST(MachineToolRules, are_marked_in_the_program_but_for_the_one_that_is_the_plcs_own) {
  EXPECT_EQ(rules_of(machine_tool_program()).size(), machine_tool_rules_count - 1);
}

TEST(MachineToolRules, a_plc_that_does_not_run_has_its_outputs_off) {
  MachineToolRules rules;
  MachineToolPlant plant;
  Terminals terminals;
  terminals.outputs.set(index_of(machine_tool::Y::green_lamp));
  const MachineToolContract stopped{.distribution_end = true, .plc_runs = false};
  const SteadyTime now{1h};
  plant.advance(terminals, now);
  const auto index = static_cast<std::size_t>(MachineToolRule::outputs_off_when_stopped);
  EXPECT_FALSE(rules.look(terminals, plant, stopped, now).test(index));
  EXPECT_TRUE(rules.look(terminals, plant, stopped, now + 26ms).test(index));
  terminals.outputs.reset();
  EXPECT_FALSE(rules.look(terminals, plant, stopped, now + 30ms).test(index));
}

TEST(InterlockRules, lines_go_and_places_stay) {
  const std::string_view source = "LD a\nAND b  (* rule: one *)\nAND c  (* rule: two *)\nST d\n";
  EXPECT_EQ(rules_of(source), (std::vector<std::string>{"one", "two"}));
  EXPECT_EQ(without_rule(source, "one"), "LD a\n\nAND c  (* rule: two *)\nST d\n");
}

}  // namespace
}  // namespace emulator_models
