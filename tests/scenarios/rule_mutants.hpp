// A scenario for each interlock that a PLC program is marked with: the same scene, the program without the lines of
// that rule, judged by that rule alone. Nothing in the scene points at it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulator_models/programs/interlock_rules.hpp"
#include "emulator_models/soft_plc/il_program.hpp"
#include "sim_clock/scenario/scenario.hpp"
#include "tests/scenarios/compiled_program.hpp"

namespace scenarios {

/// @tparam Scene  has `static constexpr std::size_t rules_count`, `static std::string_view source()`,
///                `static constexpr std::string_view group` ("machine"), and
///                `static void run(ltsim::World&, const IlProgram&, const std::string& rule)`
template <typename Scene>
class RuleMutants {
 public:
  /// Registers them, "machine/without-RULE".
  /// @return how many
  static std::size_t register_all() { return register_each(std::make_index_sequence<Scene::rules_count>()); }

 private:
  static const std::string& rule(std::size_t index) {
    static const std::vector<std::string> rules = emulator_models::rules_of(Scene::source());
    return rules.at(index);
  }

  template <std::size_t index>
  static void run(ltsim::World& world) {
    static const emulator_models::soft_plc::IlProgram program =
        compiled_for_fx3u(emulator_models::without_rule(Scene::source(), rule(index)));
    Scene::run(world, program, rule(index));
  }

  template <std::size_t index>
  static void register_one() {
    static const std::string name = std::string{Scene::group} + "/without-" + rule(index);
    static const std::string description = "the PLC program without the interlock " + rule(index);
    static const ltsim::ScenarioRegistration registration{name, description, &run<index>};
  }

  template <std::size_t... indices>
  static std::size_t register_each(std::index_sequence<indices...> /*all*/) {
    (register_one<indices>(), ...);
    return sizeof...(indices);
  }
};

}  // namespace scenarios
