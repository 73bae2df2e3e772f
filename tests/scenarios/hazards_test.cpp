// What the scenarios are there to show: outside of its envelope the published handoff breaks in each of the
// known ways, and each hazard is found by its own invariant, from every seed; inside, nothing is ever accused.

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "sim_clock/explore/swarm_strategy.hpp"
#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/paper_exchange.hpp"
#include "tests/scenarios/scenario_name.hpp"
#include "tests/scenarios/search.hpp"

namespace {

using protocol::PaperOptions;
using scenarios::explore;
using scenarios::PaperExchange;
using scenarios::world;

/// What the hazards are searched with.
using Search = ltsim::SwarmStrategy;
/// What silence is tested with, in great numbers: a kernel that waits for ever polls for ever, and the priorities
/// of pct, which swarm includes, keep the emulator from running for thousands of steps (37,000 a request, 53 in
/// a random walk).
using ManyWalks = ltsim::RandomStrategy;
constexpr std::uint64_t executions_until_found_max = 100'000;

class HazardTest : public testing::TestWithParam<ltsim::Shape> {};

TEST_P(HazardTest, is_found_by_its_own_invariant_from_every_seed_and_never_inside_the_envelope) {
  const ltsim::Shape& shape = GetParam();
  constexpr std::uint64_t seeds_count = 5;
  std::uint64_t executions_sum = 0;
  for (std::uint64_t seed = 1; seed <= seeds_count; ++seed) {
    const auto report = explore<Search>(*ltsim::find_scenario(shape.name), seed, executions_until_found_max);
    ASSERT_FALSE(report.failures.empty()) << "seed " << seed;
    const ltsim::Failure& failure = report.failures.front();
    EXPECT_TRUE(shape.is_finding(failure.outcome))
        << to_string(failure.outcome.kind) << ": " << failure.outcome.message << '\n'
        << to_string(failure.schedule);
    executions_sum += report.executions;
  }
  RecordProperty("mean_executions", std::to_string(executions_sum / seeds_count));
  const ltsim::Scenario& corrected = *ltsim::find_scenario(shape.corrected_name);
  for (const auto& silent : {explore<Search>(corrected, 1, 300), explore<ManyWalks>(corrected, 1, 5'000)})
    EXPECT_TRUE(silent.failures.empty()) << silent.failures.front().outcome.message;
}

INSTANTIATE_TEST_SUITE_P(Paper, HazardTest, testing::ValuesIn(ltsim::shapes()), [](const auto& tested) {
  return scenarios::test_name(testing::TestParamInfo<const char*>{tested.param.name.data(), 0});
});

/// Whether one of the failures breaks the invariant: "I1, I4: ..." breaks I1 and I4.
bool breaks(const ltsim::ExploreReport& report, const std::string& invariant) {
  for (const ltsim::Failure& failure : report.failures) {
    const std::string& message = failure.outcome.message;
    const std::string numbers = ", " + message.substr(0, message.find(':')) + ",";
    if (failure.outcome.kind == ltsim::OutcomeKind::invariant &&
        numbers.find(", " + invariant + ",") != std::string::npos) {
      return true;
    }
  }
  return false;
}

TEST(TimeOut, alone_breaks_all_that_follows_from_it_and_one_exploration_tells_it_apart) {
  const auto report = explore<Search>(*ltsim::find_scenario("paper/time-out"), 1, 50'000, true);
  for (const char* invariant : {"I1", "I3", "I4", "I7", "I18"})
    EXPECT_TRUE(breaks(report, invariant)) << invariant;
  for (const char* invariant : {"I2", "I5", "I6", "I9", "I11", "I14", "I17", "I28", "I29"})
    EXPECT_FALSE(breaks(report, invariant)) << invariant;
}

TEST(Demo, a_counter_without_a_lock_loses_a_part) {
  const auto report = explore<Search>(*ltsim::find_scenario("demo/parts-counter"), 1, 1'000);
  ASSERT_EQ(report.failures.size(), 1U);
  EXPECT_EQ(report.failures.front().outcome.message, "a part was not counted");
}

class SoundScenarioTest : public testing::TestWithParam<const char*> {};

TEST_P(SoundScenarioTest, is_never_accused) {
  const std::uint64_t executions = std::string{GetParam()} == "nc/part-program" ? 300 : 50'000;
  const auto report = explore<ManyWalks>(*ltsim::find_scenario(GetParam()), 1, executions);
  ASSERT_TRUE(report.failures.empty()) << to_string(report.failures.front().schedule);
}

INSTANTIATE_TEST_SUITE_P(Envelope, SoundScenarioTest,
                         testing::Values("paper/one-request", "paper/three-requests", "nc/part-program"),
                         &scenarios::test_name);

const PaperExchange* explored_exchange = nullptr;

/// Explores an exchange that has no scenario of its own.
ltsim::ExploreReport explore(const PaperExchange& exchange, std::uint64_t executions,
                             bool keep_going = false) {
  explored_exchange = &exchange;
  const ltsim::Scenario scenario{.name = "test/exchange", .description = "", .body = [](ltsim::World& in) {
                                   scenarios::run_exchange(in, *explored_exchange);
                                 }};
  return explore<ManyWalks>(scenario, 1, executions, keep_going);
}

TEST(Monitor, reports_at_the_end_what_did_no_harm_yet) {
  const auto two_in_an_area = explore<Search>(*ltsim::find_scenario("paper/time-out"), 1, 5'000, true);
  const auto filled_in_use =
      explore(PaperExchange{.options = {.initialiser = PaperOptions::Initialiser::slave}}, 5'000, true);
  const auto has = [](const ltsim::ExploreReport& report, std::string_view beginning) {
    return std::ranges::any_of(report.failures, [&](const ltsim::Failure& failure) {
      return failure.outcome.message.starts_with(beginning);
    });
  };
  EXPECT_TRUE(
      has(two_in_an_area, "I7: kernel/main writes the request while emulator/main reads the request"));
  EXPECT_TRUE(has(filled_in_use, "I29: the segment was filled with zeros while it was in use"));
}

TEST(Envelope, is_silent_with_time_outs_that_do_not_fire) {
  PaperExchange exchange{.time_outs = PaperExchange::TimeOuts::as_published, .requests = 3};
  exchange.options.read_timeout = std::chrono::hours{1};
  const auto report = explore(exchange, 50'000);
  ASSERT_TRUE(report.failures.empty()) << to_string(report.failures.front().schedule);
}

TEST(Envelope, is_silent_with_an_emulator_that_starts_late_and_a_kernel_that_reads_twice) {
  PaperExchange exchange{.requests = 2, .reads_twice = true, .emulator_is_late = true};
  const auto report = explore(inside_envelope(exchange), 5'000);
  ASSERT_TRUE(report.failures.empty()) << to_string(report.failures.front().schedule);
}

struct Knob {
  const char* name;
  PaperOptions options;
};

class KnobTest : public testing::TestWithParam<Knob> {};

TEST_P(KnobTest, does_no_harm_without_a_time_out) {
  const auto report = explore(PaperExchange{.options = GetParam().options, .requests = 3}, 5'000);
  ASSERT_TRUE(report.failures.empty()) << to_string(report.failures.front().schedule);
}

INSTANTIATE_TEST_SUITE_P(
    Paper, KnobTest,
    testing::Values(Knob{"K2_halves", {.state_coding = PaperOptions::StateCoding::halves}},
                    Knob{"K4_one", {.semaphore_maximum = PaperOptions::SemaphoreMaximum::one}},
                    Knob{"K5_nobody", {.initialiser = PaperOptions::Initialiser::nobody}},
                    Knob{"K6_bytes_first", {.area_order = PaperOptions::AreaOrder::bytes_first}},
                    Knob{"K7_nobody", {.state_taken_back = PaperOptions::StateTakenBack::by_nobody}},
                    Knob{"K9_load_again", {.length_check = PaperOptions::LengthCheck::check_and_load_again}},
                    Knob{"K9_load_once", {.length_check = PaperOptions::LengthCheck::load_once}},
                    Knob{"K10_left_over", {.semaphore_start = PaperOptions::SemaphoreStart::left_over}}),
    [](const auto& tested) { return tested.param.name; });

TEST(PartProgram, runs_to_its_end_when_nobody_is_held_up) {
  const ltsim::Schedule nothing_special{
      .scenario = "nc/part-program", .outcome = ltsim::OutcomeKind::passed, .message = {}, .deviations = {}};
  const auto report =
      ltsim::Explorer{world()}.replay(*ltsim::find_scenario("nc/part-program"), nothing_special, nullptr);
  EXPECT_TRUE(report.outcome.passed()) << report.outcome.message;
  EXPECT_GT(report.at, std::chrono::seconds{2});  // spindle, coolant and tool change take their time
}

}  // namespace
