// What the scenarios are there to show: outside of its envelope the published handoff breaks in each of the
// known ways, and each hazard is found by its own invariant, from every seed; inside, nothing is ever accused.

#include <array>
#include <cctype>
#include <chrono>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "tests/scenarios/paper_scenarios.hpp"
#include "tests/scenarios/scenario_name.hpp"

namespace {

using protocol::PaperOptions;
using scenarios::PaperExchange;
using scenarios::PaperScenario;

/// What the hazards are searched with.
using Searching = ltsim::RandomStrategy;

ltsim::World& world() {
  static ltsim::World only;
  return only;
}

ltsim::ExploreReport explore(const ltsim::Scenario& scenario, std::uint64_t seed, std::uint64_t executions,
                             bool keep_going = false) {
  Searching strategy;
  ltsim::ExploreOptions options;
  options.seed = seed;
  options.executions_max = executions;
  options.keep_going = keep_going;
  return ltsim::Explorer{world()}.explore(scenario, strategy, options);
}

/// Executions until the scenario shows what it is there for, going on after all else.
/// @return nothing if it never does
std::optional<std::uint64_t> executions_until_shown(const PaperScenario& scenario, std::uint64_t seed) {
  constexpr std::uint64_t executions_max = 100'000;
  constexpr std::uint64_t at_a_time = 1'000;
  for (std::uint64_t done = 0; done < executions_max; done += at_a_time) {
    const auto report =
        explore(*ltsim::find_scenario(scenario.name), seed * executions_max + done, at_a_time, true);
    for (const ltsim::Failure& failure : report.failures) {
      if (failure.outcome.kind == ltsim::OutcomeKind::invariant &&
          is_shown_by(scenario, failure.outcome.message))
        return done + failure.execution;
    }
  }
  return std::nullopt;
}

std::vector<PaperScenario> hazards() {
  std::vector<PaperScenario> hazards;
  for (const PaperScenario& scenario : scenarios::paper_scenarios()) {
    if (!scenario.shows.empty()) hazards.push_back(scenario);
  }
  return hazards;
}

std::string test_name(std::string_view scenario) {
  return scenarios::test_name(testing::TestParamInfo<const char*>{std::string{scenario}.c_str(), 0});
}

class HazardTest : public testing::TestWithParam<PaperScenario> {};

TEST_P(HazardTest, is_found_by_its_own_invariant_from_every_seed) {
  std::uint64_t sum = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto executions = executions_until_shown(GetParam(), seed);
    EXPECT_TRUE(executions) << "seed " << seed;
    sum += executions.value_or(0);
  }
  RecordProperty("mean_executions", std::to_string(sum / 5));
}

INSTANTIATE_TEST_SUITE_P(Paper, HazardTest, testing::ValuesIn(hazards()),
                         [](const auto& tested) { return test_name(tested.param.name); });

TEST(Demo, a_counter_without_a_lock_loses_a_part) {
  const auto report = explore(*ltsim::find_scenario("demo/parts-counter"), 1, 1'000);
  ASSERT_EQ(report.failures.size(), 1U);
  EXPECT_EQ(report.failures.front().outcome.message, "a part was not counted");
}

class SoundScenarioTest : public testing::TestWithParam<const char*> {};

TEST_P(SoundScenarioTest, is_never_accused) {
  const std::uint64_t executions = std::string{GetParam()} == "nc/part-program" ? 300 : 50'000;
  const auto report = explore(*ltsim::find_scenario(GetParam()), 1, executions);
  ASSERT_TRUE(report.failures.empty()) << to_string(report.failures.front().schedule);
}

INSTANTIATE_TEST_SUITE_P(Envelope, SoundScenarioTest,
                         testing::Values("paper/one-request", "paper/three-requests", "nc/part-program"),
                         &scenarios::test_name);

const PaperExchange* explored_exchange = nullptr;

/// Explores an exchange that has no scenario of its own.
ltsim::ExploreReport explore(const PaperExchange& exchange, std::uint64_t executions) {
  explored_exchange = &exchange;
  const ltsim::Scenario scenario{.name = "test/exchange", .description = "", .body = [](ltsim::World& in) {
                                   scenarios::run_exchange(in, *explored_exchange);
                                 }};
  return explore(scenario, 1, executions);
}

class EachHazardTest : public testing::TestWithParam<PaperScenario> {};

TEST_P(EachHazardTest, is_gone_when_its_circumstances_are) {
  // What is left of the scenario: how much is asked, how often it is read, when the emulator starts.
  PaperExchange sound{.requests = GetParam().exchange.requests,
                      .reads_twice = GetParam().exchange.reads_twice,
                      .emulator_is_late = GetParam().exchange.emulator_is_late,
                      .monitor = GetParam().exchange.monitor};
  if (sound.reads_twice) {  // the second read ends by its time-out; the first has none to fear
    sound.time_outs = PaperExchange::TimeOuts::as_published;
    sound.options.read_timeout = std::chrono::hours{1};
  }
  const auto report = explore(sound, 5'000);
  ASSERT_TRUE(report.failures.empty()) << to_string(report.failures.front().schedule);
}

INSTANTIATE_TEST_SUITE_P(Paper, EachHazardTest, testing::ValuesIn(hazards()),
                         [](const auto& tested) { return test_name(tested.param.name); });

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
