// The machine tool in the world: with its program as it is, and with each interlock rule taken out of it.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulator_models/plants/machine_tool_rules.hpp"
#include "emulator_models/programs/interlock_rules.hpp"
#include "emulator_models/programs/machine_tool_program.hpp"
#include "sim_clock/scenario/scenario.hpp"
#include "tests/scenarios/machine/machine_scene.hpp"

namespace {

using emulator_models::soft_plc::IlProgram;

const IlProgram& whole_program() {
  static const IlProgram program = scenarios::compiled_for_fx3u(emulator_models::machine_tool_program());
  return program;
}

}  // namespace

SCENARIO("machine/shift",
         "random part programs, an operator and failures on the machine tool; every interlock holds") {
  scenarios::run_shift(world, whole_program());
}

SCENARIO("machine/fin-wait-removed",
         "the kernel raises the next strobe while FIN may still be that of the last one") {
  scenarios::run_shift(
      world, whole_program(),
      {.service = scenarios::PortService::between_scans, .fin_wait = scenarios::FinWait::none});
}

SCENARIO("machine/fin-wait-removed-corrected", "the next strobe rises only when FIN is low") {
  scenarios::run_shift(world, whole_program(), {.service = scenarios::PortService::between_scans});
}

namespace {

/// One scenario for each rule: the program without its lines. The same shift as above; nothing in it points at
/// the rule.
constexpr std::size_t marked_rules_count = emulator_models::machine_tool_rules_count - 1;

const std::string& rule(std::size_t index) {
  static const std::vector<std::string> rules =
      emulator_models::rules_of(emulator_models::machine_tool_program());
  return rules.at(index);
}

template <std::size_t index>
void run_without_rule(ltsim::World& world) {
  static const IlProgram program = scenarios::compiled_for_fx3u(
      emulator_models::without_rule(emulator_models::machine_tool_program(), rule(index)));
  scenarios::run_shift(world, program, {.only_rule = rule(index)});
}

template <std::size_t index>
const ltsim::ScenarioRegistration& registration_without_rule() {
  static const std::string name = "machine/without-" + rule(index);
  static const std::string description = "the PLC program without the interlock " + rule(index);
  static const ltsim::ScenarioRegistration registration{name, description, &run_without_rule<index>};
  return registration;
}

template <std::size_t... indices>
std::size_t register_all(std::index_sequence<indices...> /*all*/) {
  (registration_without_rule<indices>(), ...);
  return sizeof...(indices);
}

[[maybe_unused]] const std::size_t registered_count =
    register_all(std::make_index_sequence<marked_rules_count>());

}  // namespace
