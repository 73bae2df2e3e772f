// Each rule of the soft PLC has a mutant without it: it is found from every seed, by the invariant that the rule is there
// for; and the PLC as it is is never accused in the same scene.

#include <algorithm>
#include <cctype>
#include <ostream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/swarm_strategy.hpp"
#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/scenario_name.hpp"

namespace ltsim {

void PrintTo(const Shape& shape, std::ostream* out) { *out << shape.name; }

}  // namespace ltsim

namespace {

constexpr std::uint64_t seeds_count = 5;
constexpr std::uint64_t executions_until_found_max = 100'000;
/// Ten times what the search needed, but so many at least, for a scene can be silent by chance; and so many at most, for the
/// test is to take a moment. README.md has a longer silence.
constexpr std::uint64_t silent_executions_min = 5'000;
constexpr std::uint64_t silent_executions_max = 20'000;

ltsim::World& world() {
  static ltsim::World only;
  return only;
}

ltsim::ExploreReport explore(std::string_view scenario, std::uint64_t seed, std::uint64_t executions) {
  ltsim::SwarmStrategy strategy;
  ltsim::ExploreOptions options;
  options.seed = seed;
  options.executions_max = executions;
  try {
    return ltsim::Explorer{world()}.explore(*ltsim::find_scenario(scenario), strategy, options);
  } catch (const ltsim::Explorer::NotSimulable& error) {
    throw std::runtime_error{error.message};  // GoogleTest shows what it says
  }
}

class PlcMutantTest : public testing::TestWithParam<ltsim::Shape> {};

TEST_P(PlcMutantTest, is_found_by_its_invariant_from_every_seed_and_the_PLC_as_it_is_is_silent) {
  const ltsim::Shape& shape = GetParam();
  std::uint64_t most_needed = 0;
  for (std::uint64_t seed = 1; seed <= seeds_count; ++seed) {
    const auto report = explore(shape.name, seed, executions_until_found_max);
    ASSERT_FALSE(report.failures.empty()) << "seed " << seed;
    const ltsim::Outcome& outcome = report.failures.front().outcome;
    EXPECT_TRUE(shape.is_finding(outcome)) << to_string(outcome.kind) << ": " << outcome.message;
    most_needed = std::max(most_needed, report.executions);
  }
  RecordProperty("most_needed", std::to_string(most_needed));
  const auto silent = explore(shape.corrected_name, 1,
                              std::clamp(10 * most_needed, silent_executions_min, silent_executions_max));
  EXPECT_TRUE(silent.failures.empty()) << silent.failures.front().outcome.message << '\n'
                                       << to_string(silent.failures.front().schedule);
}

INSTANTIATE_TEST_SUITE_P(Plc, PlcMutantTest, testing::ValuesIn(ltsim::shapes()), [](const auto& tested) {
  return scenarios::test_name(testing::TestParamInfo<const char*>{tested.param.name.data(), 0});
});

class PlcTest : public testing::TestWithParam<const char*> {};

TEST_P(PlcTest, is_never_accused) {
  const auto report = explore(GetParam(), 6, 10'000);
  EXPECT_TRUE(report.failures.empty()) << report.failures.front().outcome.message << '\n'
                                       << to_string(report.failures.front().schedule);
}

INSTANTIATE_TEST_SUITE_P(Plc, PlcTest, testing::Values("plc/catch-up", "plc/one-thread", "plc/threads"),
                         &scenarios::test_name);

TEST(PlcMutants, exist_for_each_of_I19_to_I26) {
  for (const std::string_view invariant : {"I19", "I20", "I21", "I22", "I23", "I24", "I25", "I26"}) {
    EXPECT_TRUE(std::ranges::any_of(ltsim::shapes(), [&](const ltsim::Shape& shape) {
      return shape.facts.finding == invariant;
    })) << invariant;
  }
}

}  // namespace
