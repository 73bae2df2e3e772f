// Same build, same seed: the same trace, every time, in every process; and what failed once, fails again from
// its schedule.

#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim_clock/check/signal_guard.hpp"
#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/swarm_strategy.hpp"
#include "tests/scenarios/scenario_name.hpp"
#include "tests/support/shell.hpp"

namespace {

using ltsim::Explorer;
using ltsim::find_scenario;
using ltsim::RandomStrategy;
using ltsim::SwarmStrategy;

ltsim::World& world() {
  static ltsim::World only;
  return only;
}

/// Trace hashes of the seeds 1 to `count` of a scenario, a line each.
std::string hashes_of(const char* scenario, unsigned count) {
  const ltsim::SignalGuard signals;
  Explorer explorer{world()};
  SwarmStrategy strategy;
  std::string lines;
  for (unsigned seed = 1; seed <= count; ++seed) {
    lines += fmt::format("{:016x}\n", explorer.execute(*find_scenario(scenario), strategy, seed, nullptr));
    strategy.learn(
        {.points = world().scheduler().points(), .new_states = world().coverage().new_in_execution()});
  }
  return lines;
}

/// The same, from a process of its own: this program, started anew.
std::string hashes_from_another_process(const std::string& scenario, unsigned count) {
  const test_support::TemporaryFolder folder;
  const auto result = test_support::run_in(
      folder.path(), fmt::format("'{}' --print-hashes {} {}", LTSIM_DETERMINISM_TEST, scenario, count));
  EXPECT_EQ(result.exit_code, 0);
  return result.output;
}

class DeterminismTest : public testing::TestWithParam<const char*> {};

TEST_P(DeterminismTest, two_hundred_seeds_give_the_same_traces_in_two_processes) {
  constexpr unsigned seeds = 200;
  const std::string one = hashes_from_another_process(GetParam(), seeds);
  const std::string other = hashes_from_another_process(GetParam(), seeds);
  EXPECT_EQ(one.size(), seeds * 17U);
  EXPECT_EQ(one, other);
  EXPECT_NE(one.substr(0, 16), one.substr(17, 16)) << "two seeds should not give one trace";
}

INSTANTIATE_TEST_SUITE_P(Scenarios, DeterminismTest,
                         testing::Values("paper/time-out", "paper/late-emulator", "paper/three-requests",
                                         "paper/register-time-out", "nc/part-program"),
                         &scenarios::test_name);

TEST(Replay, reproduces_one_hundred_recorded_failures_out_of_one_hundred) {
  const ltsim::SignalGuard signals;
  Explorer explorer{world()};
  RandomStrategy strategy;
  const ltsim::Scenario& scenario = *find_scenario("paper/time-out");
  unsigned failures = 0;
  for (std::uint64_t seed = 1; failures < 100; ++seed) {
    ASSERT_LT(seed, 100'000U);
    explorer.execute(scenario, strategy, seed, nullptr);
    if (world().scheduler().outcome().passed()) continue;
    ++failures;
    const ltsim::Failure failure = explorer.record(scenario, strategy, seed);
    const auto schedule = ltsim::parse_schedule(to_string(failure.schedule));
    ASSERT_TRUE(schedule) << schedule.error().reason;
    const ltsim::ReplayReport replayed = explorer.replay(scenario, *schedule, nullptr);
    EXPECT_EQ(replayed.outcome, failure.outcome);
    EXPECT_EQ(replayed.trace_hash, failure.trace_hash);
    EXPECT_FALSE(replayed.divergence);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4 && std::string_view{argv[1]} == "--print-hashes") {
    fmt::print("{}", hashes_of(argv[2], static_cast<unsigned>(std::strtoul(argv[3], nullptr, 10))));
    return 0;
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
