// The propulsion station in the world: whole, it breaks no rule; without one of them the default search names that
// rule.

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "emulator_models/programs/interlock_rules.hpp"
#include "emulator_models/programs/propulsion_program.hpp"
#include "tests/scenarios/search.hpp"

namespace {

constexpr std::uint64_t executions_until_found_max = 10'000;
constexpr std::uint64_t silent_executions = 100;

TEST(Propulsion, whole_it_breaks_no_rule) {
  const auto report = scenarios::explore("propulsion/watch", 1, silent_executions);
  ASSERT_TRUE(report.failures.empty()) << report.failures.front().outcome.message;
}

struct PropulsionWithout : ::testing::TestWithParam<std::string> {};

TEST_P(PropulsionWithout, is_found_by_the_name_of_the_rule) {
  const auto report = scenarios::explore("propulsion/without-" + GetParam(), 1, executions_until_found_max);
  ASSERT_FALSE(report.failures.empty());
  EXPECT_EQ(report.failures.front().outcome.message, GetParam());
  RecordProperty("executions", std::to_string(report.executions));
}

INSTANTIATE_TEST_SUITE_P(
    Propulsion, PropulsionWithout,
    ::testing::ValuesIn(emulator_models::rules_of(emulator_models::propulsion_program())),
    [](const auto& tried) { return tried.param; });

}  // namespace
