// A scenario as a fuzz target: run by bytes, recorded as a schedule, replayed.

#include "sim_clock/scenario/fuzz_scenario.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_clock/explore/bytes_strategy.hpp"
#include "sim_clock/explore/schedule.hpp"

namespace {

void lose_an_update(ltsim::World& world, std::size_t rounds) {
  const auto counter = std::make_shared<std::atomic<std::size_t>>(0);
  for (const char* const name : {"one", "two"}) {
    world.process("p").start(name, [counter, rounds] {
      for (std::size_t i = 0; i < rounds; ++i) *counter = *counter + 1;
    });
  }
  world.run();
  world.abstract_state(rounds);
  world.require(*counter == 2 * rounds, "an increment was lost");
}

}  // namespace

FUZZ_SCENARIO("lost-update", "two tasks count") { lose_an_update(world, 1 + world.choose("rounds", 3)); }

SCENARIO("other/always-fails", "for --scenario") {
  world.process("p").start("main", [&world] { world.violated("as ever"); });
  world.run();
}

namespace ltsim {
namespace {

using Kind = BytesStrategy::Kind;

std::vector<std::byte> bytes_of(const std::vector<BytesStrategy::Record>& records) {
  std::vector<std::byte> bytes(records.size() * BytesStrategy::record_bytes);
  for (std::size_t i = 0; i < records.size(); ++i) {
    BytesStrategy::write(
        records[i],
        std::span{bytes}.subspan(i * BytesStrategy::record_bytes).first<BytesStrategy::record_bytes>());
  }
  return bytes;
}

/// Three rounds, and a switch behind the first load of the counter.
std::vector<std::byte> failing_bytes() {
  return bytes_of({{.kind = static_cast<std::uint8_t>(Kind::answer), .skipped_count = 0, .value = 1},
                   {.kind = static_cast<std::uint8_t>(Kind::task), .skipped_count = 2, .value = 0}});
}

const FuzzTarget& target() { return *find_fuzz_target("lost-update"); }

TEST(FuzzScenario, is_a_scenario_and_a_target_of_records) {
  ASSERT_NE(find_scenario("fuzz/lost-update"), nullptr);
  ASSERT_NE(find_fuzz_target("lost-update"), nullptr);
  EXPECT_TRUE(target().needs_world());
  EXPECT_EQ(target().records(std::string(11, 'x')).size(), 3U);
}

TEST(FuzzScenario, passes_by_default_and_fails_by_the_outcome) {
  EXPECT_NO_THROW(target().run({}));
  try {
    target().run(failing_bytes());
    FAIL() << "nothing was found";
  } catch (const BrokenPromise& broken) {
    EXPECT_STREQ(broken.what(), "invariant: an increment was lost");
  }
  EXPECT_NO_THROW(target().run({}));
}

TEST(FuzzScenario, is_recorded_as_a_small_schedule_that_replays) {
  const Schedule schedule = target().scenario.record(target(), failing_bytes());
  EXPECT_EQ(schedule.scenario, "fuzz/lost-update");
  EXPECT_EQ(schedule.outcome, OutcomeKind::invariant);
  EXPECT_EQ(schedule.deviations.size(), 1U) << to_string(schedule) << "one round is enough";
  EXPECT_THROW(target().scenario.replay(schedule), BrokenPromise);
}

TEST(FuzzScenario, a_regression_whose_place_is_gone_passes_and_says_so) {
  const auto schedule = parse_schedule(
      "ltsim schedule 1\nscenario fuzz/lost-update\noutcome passed\n"
      "switch p/one before atomic_load nowhere #1 to p/two\n");
  ASSERT_TRUE(schedule) << schedule.error().reason;
  EXPECT_NE(target().scenario.replay(*schedule), "");
  Schedule without_lines = *schedule;
  without_lines.deviations.clear();
  EXPECT_EQ(target().scenario.replay(without_lines), "");
}

TEST(FuzzScenario, marks_the_states_that_it_has_told) {
  std::array<std::uint8_t, 64> marks{};
  mark_fuzzed_states_in(marks);
  target().run({});
  mark_fuzzed_states_in({});
  EXPECT_EQ(std::ranges::count(marks, 1), 1);
  EXPECT_EQ(std::ranges::count(marks, 0), 63);
}

TEST(FuzzScenario, another_scenario_can_be_steered_in_its_place) {
  EXPECT_FALSE(target().scenario.steer("other/there-is-none"));
  EXPECT_NO_THROW(target().run({}));
  EXPECT_TRUE(target().scenario.steer("other/always-fails"));
  EXPECT_THROW(target().run({}), BrokenPromise);
  EXPECT_EQ(target().scenario.record(target(), {}).scenario, "other/always-fails");
  EXPECT_TRUE(target().scenario.steer("fuzz/lost-update"));
}

}  // namespace
}  // namespace ltsim
