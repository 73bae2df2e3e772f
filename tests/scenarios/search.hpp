// How the tests of scenarios search: one world for all of them, any strategy, and what a known race is held to.
#pragma once

#include <algorithm>
#include <cstdint>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/swarm_strategy.hpp"
#include "sim_clock/scenario/shape.hpp"

namespace ltsim {

inline void PrintTo(const Shape& shape, std::ostream* out) { *out << shape.name; }

}  // namespace ltsim

namespace scenarios {

/// One world exists at a time.
inline ltsim::World& world() {
  static ltsim::World only;
  return only;
}

template <typename Strategy = ltsim::SwarmStrategy>
ltsim::ExploreReport explore(const ltsim::Scenario& scenario, std::uint64_t seed, std::uint64_t executions,
                             bool keep_going = false, ltsim::Memory memory = ltsim::Memory::sc) {
  Strategy strategy;
  ltsim::ExploreOptions options;
  options.seed = seed;
  options.executions_max = executions;
  options.keep_going = keep_going;
  options.memory = memory;
  try {
    return ltsim::Explorer{world()}.explore(scenario, strategy, options);
  } catch (const ltsim::Explorer::NotSimulable& error) {
    throw std::runtime_error{error.message};  // GoogleTest shows what it says
  }
}

/// @param scenario  a name that is registered
inline ltsim::ExploreReport explore(std::string_view scenario, std::uint64_t seed, std::uint64_t executions,
                                    ltsim::Memory memory = ltsim::Memory::sc) {
  return explore(*ltsim::find_scenario(scenario), seed, executions, false, memory);
}

struct ShapeBounds {
  std::uint64_t executions_until_found_max;
  /// Of the corrected program: ten times what the search needed. At least so many, for a cure that is none may hide
  /// the race without removing it; at most so many, for the test is to take a moment.
  std::uint64_t silent_executions_min;
  std::uint64_t silent_executions_max;
};

/// The default search finds the race by its own finding from each of five seeds, and never accuses the corrected program.
inline void expect_found_and_cured(const ltsim::Shape& shape, const ShapeBounds& bounds) {
  constexpr std::uint64_t seeds_count = 5;
  std::uint64_t most_needed = 0;
  for (std::uint64_t seed = 1; seed <= seeds_count; ++seed) {
    const auto report = explore(shape.name, seed, bounds.executions_until_found_max, shape.facts.memory);
    ASSERT_FALSE(report.failures.empty()) << "seed " << seed;
    const ltsim::Outcome& outcome = report.failures.front().outcome;
    EXPECT_TRUE(shape.is_finding(outcome)) << to_string(outcome.kind) << ": " << outcome.message << '\n'
                                           << to_string(report.failures.front().schedule);
    most_needed = std::max(most_needed, report.executions);
  }
  testing::Test::RecordProperty("most_needed", std::to_string(most_needed));
  const auto silent =
      explore(shape.corrected_name, 1,
              std::clamp(10 * most_needed, bounds.silent_executions_min, bounds.silent_executions_max),
              shape.facts.memory);
  EXPECT_TRUE(silent.failures.empty()) << silent.failures.front().outcome.message << '\n'
                                       << to_string(silent.failures.front().schedule);
}

}  // namespace scenarios
