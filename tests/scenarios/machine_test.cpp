// The machine tool in the world: whole, it breaks no rule; without one of them the default search names that rule.

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "emulator_models/programs/interlock_rules.hpp"
#include "emulator_models/programs/machine_tool_program.hpp"
#include "tests/scenarios/scenario_name.hpp"
#include "tests/scenarios/search.hpp"

namespace {

constexpr std::uint64_t executions_until_found_max = 10'000;
constexpr std::uint64_t silent_executions = 150;

ltsim::ExploreReport explore(const std::string& scenario, std::uint64_t executions) {
  return scenarios::explore(scenario, 1, executions);
}

struct WholeMachine : ::testing::TestWithParam<const char*> {};

TEST_P(WholeMachine, breaks_no_rule) {
  const auto report = explore(GetParam(), silent_executions);
  ASSERT_TRUE(report.failures.empty()) << report.failures.front().outcome.message;
}

INSTANTIATE_TEST_SUITE_P(Machine, WholeMachine,
                         ::testing::Values("machine/shift", "machine/shift-kernel-kills",
                                           "machine/shift-plc-kills", "machine/shift-stalls",
                                           "machine/shift-posts", "machine/fin-wait-removed-corrected"),
                         &scenarios::test_name);

struct MachineWithout : ::testing::TestWithParam<std::string> {};

TEST_P(MachineWithout, is_found_by_the_name_of_the_rule) {
  const auto report = explore("machine/without-" + GetParam(), executions_until_found_max);
  ASSERT_FALSE(report.failures.empty());
  EXPECT_EQ(report.failures.front().outcome.message, GetParam());
  RecordProperty("executions", std::to_string(report.executions));
}

INSTANTIATE_TEST_SUITE_P(
    Machine, MachineWithout,
    ::testing::ValuesIn(emulator_models::rules_of(emulator_models::machine_tool_program())),
    [](const auto& tried) {
      std::string name = tried.param;
      for (char& letter : name) letter = letter == '-' ? '_' : letter;
      return name;
    });

TEST(Machine, a_kernel_that_does_not_wait_for_fin_to_be_low_is_found) {
  const auto report = explore("machine/fin-wait-removed", executions_until_found_max);
  ASSERT_FALSE(report.failures.empty());
  EXPECT_TRUE(report.failures.front().outcome.message.starts_with("I27: "))
      << report.failures.front().outcome.message;
}

TEST(Machine, a_kernel_that_holds_its_strobes_for_a_fixed_time_is_found) {
  const auto report = explore("machine/o23-short-strobe", executions_until_found_max);
  ASSERT_FALSE(report.failures.empty());
  EXPECT_TRUE(report.failures.front().outcome.message.starts_with("I27: "))
      << report.failures.front().outcome.message;
}

TEST(EndlessProgram, is_stopped_by_the_watchdog_whoever_is_held_up) {
  const auto report = explore("machine/endless-program", 8);
  EXPECT_TRUE(report.failures.empty()) << report.failures.front().outcome.message;
}

TEST(EndlessProgram, takes_the_same_scheduling_points_for_the_same_seed) {
  const auto points = [](std::uint64_t seed) {
    ltsim::SwarmStrategy strategy;
    ltsim::Explorer{scenarios::world()}.execute(*ltsim::find_scenario("machine/endless-program"), strategy,
                                                seed, nullptr);
    return scenarios::world().scheduler().points();
  };
  for (std::uint64_t seed = 1; seed <= 3; ++seed) EXPECT_EQ(points(seed), points(seed)) << seed;
}

TEST(EndlessProgram, is_stopped_within_150_ms_when_nobody_is_held_up) {
  const ltsim::Schedule nothing_special{.scenario = "machine/endless-program",
                                        .outcome = ltsim::OutcomeKind::passed,
                                        .message = {},
                                        .deviations = {}};
  const auto report = ltsim::Explorer{scenarios::world()}.replay(
      *ltsim::find_scenario("machine/endless-program"), nothing_special, nullptr);
  EXPECT_TRUE(report.outcome.passed()) << report.outcome.message;
  // Three scans of 10 ms, then the one that hangs.
  EXPECT_GT(report.at, std::chrono::milliseconds{180});
  EXPECT_LT(report.at, std::chrono::milliseconds{181});
}

}  // namespace
