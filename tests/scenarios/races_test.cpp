// What the known races are there to show: the default search finds each by its own finding, from every seed; its
// schedule gives the same execution each time; and the corrected program is never accused.

#include <algorithm>
#include <cctype>
#include <chrono>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/minimizer.hpp"
#include "sim_clock/explore/swarm_strategy.hpp"
#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/search.hpp"

namespace {

constexpr std::uint64_t seeds_count = 5;
constexpr std::uint64_t executions_until_found_max = 40'000;
constexpr std::uint64_t silent_executions_min = 5'000;
constexpr std::uint64_t silent_executions_max = 30'000;
constexpr std::uint64_t executions_of_weak_memory_max = 1'000;
constexpr std::uint64_t silent_executions_of_weak_memory = 20'000;

using scenarios::explore;
using scenarios::world;

class ShapeTest : public testing::TestWithParam<ltsim::Shape> {};

TEST_P(ShapeTest, is_found_from_every_seed_and_its_corrected_program_is_silent) {
  scenarios::expect_found_and_cured(
      GetParam(), {executions_until_found_max, silent_executions_min, silent_executions_max});
}

/// Ordering constraints that the program needs, as probabilistic concurrency testing counts them. Three programs have a
/// freedom that the catalogue's models of them do not have, and each costs one more.
unsigned depth_of_program(const ltsim::Shape& shape) {
  const bool clock_must_stop_again = shape.name == "races/o02-stale-response";  // in the model it fires once
  const bool scan_must_have_begun =
      shape.name == "races/o17-watchdog-kicked-by-the-wrong-thread";  // there it hangs at once
  const bool either_may_create =
      shape.name == "races/o27-reopen-race";  // there one creates and the other opens
  return shape.facts.depth + (clock_must_stop_again || scan_must_have_begun || either_may_create ? 1U : 0U);
}

/// The bar of the race catalogue: 20 n k^(d-1) executions, of n tasks and k scheduling points at depth d. The clock and
/// each kind of fault are tasks of their own there. k is counted in the default execution.
std::uint64_t executions_max_of_pct(const ltsim::Shape& shape) {
  ltsim::Schedule nothing_special;
  nothing_special.scenario = shape.name;
  nothing_special.memory = shape.facts.memory;
  static_cast<void>(
      ltsim::Explorer{world()}.replay(*ltsim::find_scenario(shape.name), nothing_special, nullptr));
  const std::uint64_t points = std::max<std::uint64_t>(world().scheduler().points(), 1);
  std::uint64_t tasks_count = shape.facts.tasks_count + (world().scheduler().time_has_mattered() ? 1U : 0U);
  for (std::size_t kind = 0; kind < ltsim::fault_kinds_count; ++kind)
    tasks_count += world().faults().can_strike(static_cast<ltsim::FaultKind>(kind)) ? 1U : 0U;
  std::uint64_t executions = 20U * tasks_count;
  for (unsigned depth = 1; depth < depth_of_program(shape) && executions < executions_until_found_max;
       ++depth)
    executions *= points;
  return std::min(executions, executions_until_found_max);
}

TEST_P(ShapeTest, is_found_by_pct_within_the_bar_of_the_catalogue) {
  const ltsim::Shape& shape = GetParam();
  const std::uint64_t executions = executions_max_of_pct(shape);
  for (std::uint64_t seed = 1; seed <= seeds_count; ++seed) {
    ltsim::PctStrategy strategy;
    ltsim::ExploreOptions options;
    options.seed = seed;
    options.executions_max = executions;
    options.memory = shape.facts.memory;
    const auto report =
        ltsim::Explorer{world()}.explore(*ltsim::find_scenario(shape.name), strategy, options);
    ASSERT_FALSE(report.failures.empty()) << "seed " << seed << ", " << executions << " executions";
    EXPECT_TRUE(shape.is_finding(report.failures.front().outcome));
  }
}

TEST_P(ShapeTest, has_a_minimal_schedule_of_at_most_one_line_more_than_its_depth_and_needs_each_line) {
  const ltsim::Shape& shape = GetParam();
  const ltsim::Scenario& scenario = *ltsim::find_scenario(shape.name);
  const auto report = explore(shape.name, 1, executions_until_found_max, shape.facts.memory);
  ASSERT_FALSE(report.failures.empty());
  // Bounded by executions, so that a busy machine makes no difference.
  const auto minimized = ltsim::Minimizer{world(), scenario}.minimize(
      report.failures.front().schedule,
      {.seconds_max = std::chrono::seconds{60}, .executions_max = 100'000, .numbers_matter = false});
  ASSERT_TRUE(minimized.reproduced);
  const ltsim::Schedule& schedule = minimized.schedule;
  EXPECT_LE(schedule.deviations.size(), shape.facts.depth + 1U) << to_string(schedule);
  const auto fails = [&](const ltsim::Schedule& tried) {
    const auto outcome = ltsim::Explorer{world()}.replay(scenario, tried, nullptr).outcome;
    return outcome.kind == schedule.outcome && ltsim::one_line(outcome.message) == schedule.message;
  };
  EXPECT_TRUE(fails(schedule));
  for (std::size_t line = 0; line < schedule.deviations.size(); ++line) {
    ltsim::Schedule without = schedule;
    without.deviations.erase(without.deviations.begin() + static_cast<std::ptrdiff_t>(line));
    EXPECT_FALSE(fails(without)) << "not needed: " << to_string(schedule.deviations[line]);
  }
}

TEST_P(ShapeTest, replays_to_the_same_trace_a_hundred_times) {
  const auto report = explore(GetParam().name, 1, executions_until_found_max, GetParam().facts.memory);
  ASSERT_FALSE(report.failures.empty());
  const ltsim::Failure& failure = report.failures.front();
  // Through its text, as from a file.
  const auto schedule = ltsim::parse_schedule(to_string(failure.schedule));
  ASSERT_TRUE(schedule.has_value()) << schedule.error().reason;
  const ltsim::Scenario& scenario = *ltsim::find_scenario(GetParam().name);
  for (int i = 0; i < 100; ++i) {
    const auto replayed = ltsim::Explorer{world()}.replay(scenario, *schedule, nullptr);
    ASSERT_FALSE(replayed.divergence) << replayed.divergence->reason;
    ASSERT_EQ(replayed.trace_hash, failure.trace_hash);
  }
}

TEST_P(ShapeTest, a_seed_gives_the_same_execution_again_whatever_was_learned_before) {
  const ltsim::Scenario& scenario = *ltsim::find_scenario(GetParam().name);
  ltsim::Explorer explorer{world()};
  ltsim::SwarmStrategy strategy;
  world().set_default_memory(GetParam().facts.memory);
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const std::uint64_t hash = explorer.execute(scenario, strategy, seed, nullptr);
    ASSERT_EQ(explorer.execute(scenario, strategy, seed, nullptr), hash) << "seed " << seed;
    strategy.learn({.points = world().scheduler().points()});
  }
}

std::string test_name(const testing::TestParamInfo<ltsim::Shape>& tested) {
  std::string name{tested.param.name.substr(tested.param.name.find('/') + 1)};
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Zoo, ShapeTest, testing::ValuesIn(ltsim::shapes()), &test_name);

/// The known races that there are only where memory is weak.
class WeakMemoryShapeTest : public testing::TestWithParam<ltsim::Shape> {};

TEST_P(WeakMemoryShapeTest, is_found_soon_from_each_of_twenty_seeds) {
  const ltsim::Shape& shape = GetParam();
  constexpr std::uint64_t many_seeds_count = 20;
  for (std::uint64_t seed = 1; seed <= many_seeds_count; ++seed) {
    const auto report = explore(shape.name, seed, executions_of_weak_memory_max, shape.facts.memory);
    ASSERT_FALSE(report.failures.empty()) << "seed " << seed;
    EXPECT_TRUE(shape.is_finding(report.failures.front().outcome)) << "seed " << seed;
  }
}

TEST_P(WeakMemoryShapeTest, is_silent_if_memory_is_sequentially_consistent_or_the_program_is_corrected) {
  const ltsim::Shape& shape = GetParam();
  for (const auto& report :
       {explore(shape.name, 1, silent_executions_of_weak_memory, ltsim::Memory::sc),
        explore(shape.corrected_name, 1, silent_executions_of_weak_memory, shape.facts.memory)}) {
    EXPECT_TRUE(report.failures.empty()) << report.failures.front().outcome.message << '\n'
                                         << to_string(report.failures.front().schedule);
  }
}

std::vector<ltsim::Shape> shapes_of_weak_memory() {
  std::vector<ltsim::Shape> weak = ltsim::shapes();
  std::erase_if(weak, [](const ltsim::Shape& shape) { return shape.facts.memory == ltsim::Memory::sc; });
  return weak;
}

INSTANTIATE_TEST_SUITE_P(Zoo, WeakMemoryShapeTest, testing::ValuesIn(shapes_of_weak_memory()), &test_name);

TEST(Shape, is_found_by_its_own_finding_only) {
  const ltsim::Shape by_invariant{.name = {}, .corrected_name = {}, .facts = {.finding = "I1", .cure = {}}};
  EXPECT_TRUE(by_invariant.is_finding({ltsim::OutcomeKind::invariant, "I1: foreign"}));
  EXPECT_TRUE(by_invariant.is_finding({ltsim::OutcomeKind::invariant, "I1, I4: foreign"}));
  EXPECT_FALSE(by_invariant.is_finding({ltsim::OutcomeKind::invariant, "I18: never ended"}));
  EXPECT_FALSE(by_invariant.is_finding({ltsim::OutcomeKind::deadlock, "I1: foreign"}));
  EXPECT_FALSE(by_invariant.is_finding({}));
  const ltsim::Shape by_outcome{
      .name = {}, .corrected_name = {}, .facts = {.finding = "deadlock", .cure = {}}};
  EXPECT_TRUE(by_outcome.is_finding({ltsim::OutcomeKind::deadlock, "all wait"}));
  EXPECT_FALSE(by_outcome.is_finding({ltsim::OutcomeKind::livelock, "no end"}));
}

TEST(Shapes, are_registered_in_pairs) {
  ASSERT_GE(ltsim::shapes().size(), 30U);
  for (const ltsim::Shape& shape : ltsim::shapes()) {
    EXPECT_NE(ltsim::find_scenario(shape.name), nullptr) << shape.name;
    EXPECT_NE(ltsim::find_scenario(shape.corrected_name), nullptr) << shape.name;
    EXPECT_EQ(ltsim::find_shape(shape.name)->facts.cure, shape.facts.cure);
  }
  EXPECT_EQ(ltsim::find_shape("races/o01-lost-wake-up-corrected"), nullptr);
}

}  // namespace
