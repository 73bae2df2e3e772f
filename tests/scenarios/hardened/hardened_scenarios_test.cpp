// The hardened handoff keeps its invariants under time-outs and kills, whatever the memory; each mutant is found by the
// invariant that its rule is there for, or as a data race, and its corrected program is silent.

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/scenario_name.hpp"
#include "tests/scenarios/search.hpp"

namespace {

using scenarios::explore;

class MutantTest : public testing::TestWithParam<ltsim::Shape> {};

TEST_P(MutantTest, is_found_by_its_own_invariant_from_every_seed_and_with_its_rule_never) {
  scenarios::expect_found_and_cured(GetParam(), {.executions_until_found_max = 400'000,
                                                 .silent_executions_min = 5'000,
                                                 .silent_executions_max = 30'000});
}

INSTANTIATE_TEST_SUITE_P(Hardened, MutantTest, testing::ValuesIn(ltsim::shapes()), [](const auto& tested) {
  return scenarios::test_name(testing::TestParamInfo<const char*>{tested.param.name.data(), 0});
});

TEST(Mutants, lack_one_of_nine_rules_or_one_of_six_orders) { EXPECT_EQ(ltsim::shapes().size(), 15U); }

class SetUpTest : public testing::TestWithParam<std::string_view> {};

TEST_P(SetUpTest, breaks_no_invariant_with_either_memory) {
  for (const ltsim::Memory memory : {ltsim::Memory::sc, ltsim::Memory::c11}) {
    const auto report = explore(GetParam(), 1, 5'000, memory);
    EXPECT_TRUE(report.failures.empty()) << report.failures.front().outcome.message << '\n'
                                         << to_string(report.failures.front().schedule);
  }
}

/// The scenarios that are no half of a shape.
std::vector<std::string_view> set_ups() {
  std::vector<std::string_view> names;
  for (const ltsim::Scenario& scenario : ltsim::scenarios()) names.push_back(scenario.name);
  for (const ltsim::Shape& shape : ltsim::shapes()) {
    std::erase(names, shape.name);
    std::erase(names, shape.corrected_name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(Hardened, SetUpTest, testing::ValuesIn(set_ups()), [](const auto& tested) {
  return scenarios::test_name(testing::TestParamInfo<const char*>{tested.param.data(), 0});
});

}  // namespace
