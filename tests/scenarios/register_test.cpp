// What the register scenarios are there to show: the handoff is linearizable inside its envelope, and with time-outs
// the random walk finds answers that no order of the requests gives, from every seed.

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "sim_clock/scenario/scenario.hpp"

namespace {

/// @return the message of the first failure; empty if there is none
std::string first_failure(const char* scenario, std::uint64_t seed, std::uint64_t executions) {
  static ltsim::World world;
  ltsim::RandomStrategy strategy;
  ltsim::ExploreOptions options;
  options.seed = seed;
  options.executions_max = executions;
  const auto report = ltsim::Explorer{world}.explore(*ltsim::find_scenario(scenario), strategy, options);
  return report.failures.empty() ? std::string{} : report.failures.front().outcome.message;
}

class RegisterTest : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RegisterTest, is_linearizable_without_time_outs) {
  EXPECT_EQ(first_failure("paper/register", GetParam(), 5'000), "");
}

TEST_P(RegisterTest, shows_a_stale_answer_after_a_time_out) {
  EXPECT_TRUE(first_failure("paper/register-time-out", GetParam(), 20'000)
                  .starts_with("history is not linearizable: "));
}

TEST_P(RegisterTest, adds_twice_what_was_sent_again) {
  EXPECT_TRUE(first_failure("paper/register-send-again", GetParam(), 20'000)
                  .starts_with("history is not linearizable: "));
}

INSTANTIATE_TEST_SUITE_P(Paper, RegisterTest, testing::Range<std::uint64_t>(1, 11));

}  // namespace
