// The propulsion station in the world: with its program as it is, and with each rule taken out of it.

#include <cstddef>
#include <string>
#include <string_view>

#include "emulator_models/plants/propulsion_rules.hpp"
#include "emulator_models/programs/propulsion_program.hpp"
#include "sim_clock/scenario/scenario.hpp"
#include "tests/scenarios/compiled_program.hpp"
#include "tests/scenarios/propulsion/propulsion_scene.hpp"
#include "tests/scenarios/rule_mutants.hpp"

namespace {

using emulator_models::soft_plc::IlProgram;

struct WatchWithoutRule {
  static constexpr std::string_view group = "propulsion";
  static constexpr std::size_t rules_count = emulator_models::propulsion_rules_count;
  static std::string_view source() { return emulator_models::propulsion_program(); }
  static void run(ltsim::World& world, const IlProgram& program, const std::string& rule) {
    scenarios::keep_watch(world, program, rule);
  }
};

[[maybe_unused]] const std::size_t registered_count =
    scenarios::RuleMutants<WatchWithoutRule>::register_all();

}  // namespace

SCENARIO("propulsion/watch",
         "a crew, a station that polls, and failures at the propulsion plant; every rule holds") {
  static const IlProgram program = scenarios::compiled_for_fx3u(emulator_models::propulsion_program());
  scenarios::keep_watch(world, program);
}
