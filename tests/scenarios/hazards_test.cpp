// What the scenarios are there to show: outside of its envelope the published handoff breaks in each of the
// known ways, and each hazard is found by its own invariant, from every seed; inside, nothing is ever accused. The
// hazard of weak memory is one more: all executions show that it takes weak memory, and that its cure is one.

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/prover.hpp"
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
    const auto report = explore<Search>(*ltsim::find_scenario(shape.name), seed, executions_until_found_max,
                                        false, shape.facts.memory);
    ASSERT_FALSE(report.failures.empty()) << "seed " << seed;
    const ltsim::Failure& failure = report.failures.front();
    EXPECT_TRUE(shape.is_finding(failure.outcome))
        << to_string(failure.outcome.kind) << ": " << failure.outcome.message << '\n'
        << to_string(failure.schedule);
    executions_sum += report.executions;
  }
  RecordProperty("mean_executions", std::to_string(executions_sum / seeds_count));
  const ltsim::Scenario& corrected = *ltsim::find_scenario(shape.corrected_name);
  for (const auto& silent : {explore<Search>(corrected, 1, 300, false, shape.facts.memory),
                             explore<ManyWalks>(corrected, 1, 5'000, false, shape.facts.memory)})
    EXPECT_TRUE(silent.failures.empty()) << silent.failures.front().outcome.message;
}

INSTANTIATE_TEST_SUITE_P(Paper, HazardTest, testing::ValuesIn(ltsim::shapes()), [](const auto& tested) {
  return scenarios::test_name(testing::TestParamInfo<const char*>{tested.param.name.data(), 0});
});

constexpr std::string_view of_weak_memory = "paper/h17-answer-before-its-bytes";

TEST(WeakMemory, is_found_soon_from_each_of_twenty_seeds) {  // H17
  const ltsim::Shape& shape = *ltsim::find_shape(of_weak_memory);
  constexpr std::uint64_t soon = 40;  // 20 for each task: the bar of depth 1, races_test.cpp
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto report = explore(shape.name, seed, soon, shape.facts.memory);
    ASSERT_FALSE(report.failures.empty()) << "seed " << seed;
    EXPECT_TRUE(shape.is_finding(report.failures.front().outcome)) << report.failures.front().outcome.message;
  }
}

TEST(WeakMemory, has_a_hazard_that_is_silent_in_great_numbers_where_it_is_not_weak_or_where_it_is_cured) {
  const ltsim::Shape& shape = *ltsim::find_shape(of_weak_memory);
  constexpr std::uint64_t great_number = 20'000;
  for (const auto& report : {explore(shape.name, 1, great_number, ltsim::Memory::sc),
                             explore(shape.corrected_name, 1, great_number, shape.facts.memory)}) {
    EXPECT_TRUE(report.failures.empty()) << to_string(report.failures.front().schedule);
  }
}

ltsim::ProveReport prove(const ltsim::Scenario& scenario, ltsim::Memory memory) {
  return ltsim::Prover{world()}.prove(scenario, {.bounds = {}, .memory = memory, .seconds_max = {}}, {},
                                      [](const ltsim::ProveReport&) { return true; });
}

TEST(WeakMemory, breaks_the_handoff_in_some_execution_and_in_none_does_it_break_where_memory_is_not_weak) {
  const ltsim::Shape& shape = *ltsim::find_shape(of_weak_memory);
  const auto weak = prove(*ltsim::find_scenario(shape.name), shape.facts.memory);
  ASSERT_TRUE(weak.failure.has_value());
  EXPECT_TRUE(shape.is_finding(weak.failure->outcome)) << weak.failure->outcome.message;
  const auto strong = prove(*ltsim::find_scenario(shape.name), ltsim::Memory::sc);
  EXPECT_FALSE(strong.failure.has_value()) << strong.failure->outcome.message;
  EXPECT_TRUE(strong.complete);
  EXPECT_EQ(strong.counts.cut_off, 0U);
}

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

/// The scenario of an exchange that has none of its own; one at a time.
ltsim::Scenario scenario_of(const PaperExchange& exchange) {
  explored_exchange = &exchange;
  return {.name = "test/exchange", .description = "", .body = [](ltsim::World& in) {
            scenarios::run_exchange(in, *explored_exchange);
          }};
}

ltsim::ExploreReport explore(const PaperExchange& exchange, std::uint64_t executions, bool keep_going = false,
                             ltsim::Memory memory = ltsim::Memory::sc) {
  return explore<ManyWalks>(scenario_of(exchange), 1, executions, keep_going, memory);
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

// The corrected scenario of H17 makes this exchange, and is judged by one invariant: here it is by all.
TEST(Envelope, holds_in_every_execution_on_weak_memory_once_the_answer_is_ordered) {
  PaperExchange exchange;
  exchange.options.answer_order = PaperOptions::AnswerOrder::release_and_acquire;
  const auto proof = prove(scenario_of(exchange), ltsim::Memory::c11);
  EXPECT_FALSE(proof.failure.has_value()) << proof.failure->outcome.message;
  EXPECT_TRUE(proof.complete);
  EXPECT_EQ(proof.counts.cut_off, 0U);
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

TEST_P(KnobTest, does_no_harm_in_weak_memory_either_once_the_answer_is_ordered) {
  PaperExchange exchange{.options = GetParam().options, .requests = 3};
  exchange.options.answer_order = PaperOptions::AnswerOrder::release_and_acquire;
  const auto report = explore(exchange, 5'000, false, ltsim::Memory::c11);
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
                    Knob{"K10_left_over", {.semaphore_start = PaperOptions::SemaphoreStart::left_over}},
                    Knob{"K12_release_and_acquire",
                         {.answer_order = PaperOptions::AnswerOrder::release_and_acquire}}),
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
