// What the scenarios are there to show: the published handoff is sound inside its envelope, and outside of it
// the random walk finds the hazard by its own invariant, from every seed.

#include <string>

#include <gtest/gtest.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "tests/scenarios/scenario_name.hpp"

namespace {

ltsim::World& world() {
  static ltsim::World only;
  return only;
}

ltsim::ExploreReport explore(const char* scenario, std::uint64_t seed, std::uint64_t executions,
                             bool keep_going = false) {
  ltsim::RandomStrategy strategy;
  ltsim::ExploreOptions options;
  options.seed = seed;
  options.executions_max = executions;
  options.keep_going = keep_going;
  return ltsim::Explorer{world()}.explore(*ltsim::find_scenario(scenario), strategy, options);
}

/// Whether one of the failures breaks the invariant, "I3" or "I1, I4".
bool breaks(const ltsim::ExploreReport& report, const std::string& invariant) {
  for (const ltsim::Failure& failure : report.failures) {
    const std::string numbers = failure.outcome.message.substr(0, failure.outcome.message.find(':'));
    if (failure.outcome.kind == ltsim::OutcomeKind::invariant && numbers.find(invariant) != std::string::npos)
      return true;
  }
  return false;
}

class SeedTest : public testing::TestWithParam<std::uint64_t> {};

TEST_P(SeedTest, a_time_out_delivers_a_foreign_answer_or_executes_what_nobody_sent) {
  const auto report = explore("paper/time-out", GetParam(), 20'000, true);
  EXPECT_TRUE(breaks(report, "I1") || breaks(report, "I3"));
}

TEST_P(SeedTest, a_semaphore_reset_after_the_answer_loses_a_wake_up) {
  const auto report = explore("paper/semaphore-reset", GetParam(), 1'000);
  EXPECT_TRUE(breaks(report, "I9"));
}

TEST_P(SeedTest, a_late_emulator_executes_the_last_request_several_times) {
  EXPECT_TRUE(breaks(explore("paper/late-emulator", GetParam(), 1'000, true), "I5"));
}

INSTANTIATE_TEST_SUITE_P(Paper, SeedTest, testing::Range<std::uint64_t>(1, 21));

TEST(Demo, a_counter_without_a_lock_loses_a_part) {
  const auto report = explore("demo/parts-counter", 1, 1'000);
  ASSERT_EQ(report.failures.size(), 1U);
  EXPECT_EQ(report.failures.front().outcome.message, "a part was not counted");
}

class SoundScenarioTest : public testing::TestWithParam<const char*> {};

TEST_P(SoundScenarioTest, is_never_accused) {
  const auto report = explore(GetParam(), 1, std::string{GetParam()} == "nc/part-program" ? 300 : 50'000);
  ASSERT_TRUE(report.failures.empty()) << to_string(report.failures.front().schedule);
}

INSTANTIATE_TEST_SUITE_P(Envelope, SoundScenarioTest,
                         testing::Values("paper/one-request", "paper/three-requests", "nc/part-program"),
                         &scenarios::test_name);

TEST(PartProgram, runs_to_its_end_when_nobody_is_held_up) {
  const ltsim::Schedule nothing_special{
      .scenario = "nc/part-program", .outcome = ltsim::OutcomeKind::passed, .message = {}, .deviations = {}};
  const auto report =
      ltsim::Explorer{world()}.replay(*ltsim::find_scenario("nc/part-program"), nothing_special, nullptr);
  EXPECT_TRUE(report.outcome.passed()) << report.outcome.message;
  EXPECT_GT(report.at, std::chrono::seconds{2});  // spindle, coolant and tool change take their time
}

}  // namespace
