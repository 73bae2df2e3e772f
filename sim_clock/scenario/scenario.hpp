// SCENARIO(): a named function that sets up a world.
//
//     #include "sim_clock/scenario/scenario.hpp"
//
//     SCENARIO("demo/two-increments", "two tasks increment a shared counter without a lock") {
//       ...
//       world.run();
//     }
//
// A program that links ltsim::scenario_main has the command line of ltsim over all scenarios compiled into
// it.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "sim_clock/world/world.hpp"

namespace ltsim {

struct Scenario {
  std::string_view name;  ///< "group/what", without blanks
  std::string_view description;
  std::function<void(World& world)> body;
  std::vector<std::string> program = {};  ///< of a whole program: its path and its arguments
  /// If there is one: a worker calls it before its first execution, or before it forks a process for that.
  std::function<void()> prepare = {};
};

/// All scenarios of this program, by name; with "fuzz/NAME" for each FUZZ_TARGET(), whose bytes are World::input().
[[nodiscard]] const std::vector<Scenario>& scenarios();
/// @return null if there is none of that name
[[nodiscard]] const Scenario* find_scenario(std::string_view name);

/// Adds a scenario before main(). A name given twice ends the program with exit code 2.
struct ScenarioRegistration {
  /// @param name, description  outlive the program's scenarios
  ScenarioRegistration(std::string_view name, std::string_view description, std::function<void(World&)> body);
};

/// Adds a whole program as a scenario.
/// @param scenario  its name and description outlive the program's scenarios
void add_program_scenario(Scenario scenario);

}  // namespace ltsim

#define LTSIM_JOIN_(a, b) a##b
#define LTSIM_JOIN(a, b) LTSIM_JOIN_(a, b)

#define SCENARIO(name, description)                                                     \
  static void LTSIM_JOIN(ltsim_scenario_, __LINE__)(::ltsim::World & world);            \
  static const ::ltsim::ScenarioRegistration LTSIM_JOIN(ltsim_registration_, __LINE__){ \
      name, description, &LTSIM_JOIN(ltsim_scenario_, __LINE__)};                       \
  static void LTSIM_JOIN(ltsim_scenario_, __LINE__)([[maybe_unused]] ::ltsim::World & world)
