// Each rule of the soft PLC has a mutant without it: it is found from every seed, by the invariant that the rule is there
// for; and the PLC as it is is never accused in the same scene.

#include <algorithm>
#include <string_view>

#include <gtest/gtest.h>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/scenario_name.hpp"
#include "tests/scenarios/search.hpp"

namespace {

constexpr std::uint64_t executions_until_found_max = 100'000;
constexpr std::uint64_t silent_executions_min = 5'000;
constexpr std::uint64_t silent_executions_max = 20'000;  // README.md has a longer silence

class PlcMutantTest : public testing::TestWithParam<ltsim::Shape> {};

TEST_P(PlcMutantTest, is_found_by_its_invariant_from_every_seed_and_the_PLC_as_it_is_is_silent) {
  scenarios::expect_found_and_cured(
      GetParam(), {executions_until_found_max, silent_executions_min, silent_executions_max});
}

INSTANTIATE_TEST_SUITE_P(Plc, PlcMutantTest, testing::ValuesIn(ltsim::shapes()), [](const auto& tested) {
  return scenarios::test_name(testing::TestParamInfo<const char*>{tested.param.name.data(), 0});
});

class PlcTest : public testing::TestWithParam<const char*> {};

TEST_P(PlcTest, is_never_accused) {
  const auto report = scenarios::explore(GetParam(), 6, 10'000);
  EXPECT_TRUE(report.failures.empty()) << report.failures.front().outcome.message << '\n'
                                       << to_string(report.failures.front().schedule);
}

INSTANTIATE_TEST_SUITE_P(Plc, PlcTest,
                         testing::Values("plc/catch-up", "plc/gateway", "plc/gateway-one-thread",
                                         "plc/one-thread", "plc/threads"),
                         &scenarios::test_name);

TEST(PlcMutants, exist_for_each_of_I19_to_I26) {
  for (const std::string_view invariant : {"I19", "I20", "I21", "I22", "I23", "I24", "I25", "I26"}) {
    EXPECT_TRUE(std::ranges::any_of(ltsim::shapes(), [&](const ltsim::Shape& shape) {
      return shape.facts.finding == invariant;
    })) << invariant;
  }
}

}  // namespace
