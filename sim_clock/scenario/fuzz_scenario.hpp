// FUZZ_SCENARIO(): a scenario whose choices a fuzzing engine makes.
//
//     #include "sim_clock/scenario/fuzz_scenario.hpp"
//
//     FUZZ_SCENARIO("handoff-schedule", "requests, faults and time through the whole handoff") {
//       ... as the body of a SCENARIO() ...
//       world.run();
//     }
//
// It is the scenario "fuzz/handoff-schedule" and the fuzz target "handoff-schedule", whose bytes are records of BytesStrategy:
// each run is one execution, and fails unless its outcome is `passed`. What was found is handed over as a schedule like any
// other, recorded by the program that found it: records count decisions, which other builds may have at other places, and a
// schedule names them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "sim_clock/scenario/fuzz_target.hpp"
#include "sim_clock/scenario/scenario.hpp"

namespace ltsim {

/// From now on what an execution shows is marked in these bytes (Coverage::mark_in()).
void mark_fuzzed_states_in(std::span<std::uint8_t> marks);

/// Steers one execution of the scenario by the bytes, or of the one that was chosen in its place.
/// @throw BrokenPromise unless the outcome is `passed`
void run_fuzz_scenario(const Scenario& own, std::span<const std::byte> bytes);

/// Adds a scenario and its target before main().
struct FuzzScenarioRegistration {
  /// @param scenario_name  "fuzz/" and the name
  FuzzScenarioRegistration(std::string_view name, std::string_view scenario_name,
                           std::string_view description, void (*body)(World&),
                           void (*run)(std::span<const std::byte> input));
};

}  // namespace ltsim

#define FUZZ_SCENARIO(name, description)                                                           \
  static void LTSIM_JOIN(ltsim_fuzz_scenario_, __LINE__)(::ltsim::World & world);                  \
  static const ::ltsim::FuzzScenarioRegistration LTSIM_JOIN(ltsim_fuzz_scenario_added_, __LINE__){ \
      name, "fuzz/" name, description, &LTSIM_JOIN(ltsim_fuzz_scenario_, __LINE__),                \
      [](std::span<const std::byte> input) {                                                       \
        static const ::ltsim::Scenario& own = *::ltsim::find_scenario("fuzz/" name);               \
        ::ltsim::run_fuzz_scenario(own, input);                                                    \
      }};                                                                                          \
  static void LTSIM_JOIN(ltsim_fuzz_scenario_, __LINE__)([[maybe_unused]] ::ltsim::World & world)
