#include "sim_clock/explore/minimizer.hpp"

#include <fcntl.h>
#include <semaphore.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "sim_clock/explore/anchor_weakness.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "sim_clock/explore/same_failure.hpp"
#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

using namespace std::chrono_literals;

// Depth 2: one switch between the load and the store.
void lost_update(World& world) {
  const auto counter = std::make_shared<std::atomic<int>>(0);
  for (const char* name : {"one", "two"}) {
    world.process("p").start(name, [counter] {
      for (int i = 0; i < 3; ++i) *counter = *counter + 1;
    });
  }
  world.run();
  world.require(*counter == 6, "an increment was lost");
}

// Depth 2: who sleeps is asked before the sleeper says that it does.
void lost_wake_up(World& world) {
  struct Shared {
    std::atomic<bool> ready = false;
    std::atomic<bool> sleeps = false;
  };
  const auto shared = std::make_shared<Shared>();
  world.process("p").start("sleeper", [shared] {
    sem_t* const doorbell = sem_open("/doorbell", O_CREAT, 0600, 0);
    if (!shared->ready) {
      shared->sleeps = true;
      sem_wait(doorbell);
    }
  });
  world.process("q").start("waker", [shared] {
    sem_t* const doorbell = sem_open("/doorbell", O_CREAT, 0600, 0);
    shared->ready = true;
    if (shared->sleeps) sem_post(doorbell);
  });
  world.run();
}

// Depth 3: each of three tasks must be stopped halfway.
void three_half_done(World& world) {
  const auto half_done = std::make_shared<std::atomic<int>>(0);
  for (const char* name : {"one", "two", "three", "four"}) {
    world.process("p").start(name, [half_done, &world] {
      for (int i = 0; i < 3; ++i) std::atomic<int>{0} = i;
      if (++*half_done == 4) world.violated("four are half done");
      --*half_done;
      for (int i = 0; i < 3; ++i) std::atomic<int>{0} = i;
    });
  }
  world.run();
}

// A question, a slow moment of one task, and a time that must be long enough.
void late_answer(World& world) {
  const auto answered = std::make_shared<std::atomic<bool>>(false);
  const std::size_t retries = world.choose("retries", 6);
  world.process("p").start("answerer", [answered] {
    std::this_thread::sleep_for(1ms);
    *answered = true;
  });
  world.process("p").start("asker", [answered, retries, &world] {
    std::this_thread::sleep_for(30ms);
    world.require(*answered || retries < 2, "no answer after 30 ms");
  });
  world.run();
}

void takes_time(World& world) {
  world.process("p").start("quick", [] { std::this_thread::sleep_for(3ms); });
  world.process("p").start("slow", [&world] {
    const SimTime begin = world.now();
    std::this_thread::sleep_for(1ms);
    const SimTime took = world.now() - begin;
    if (took > 2ms) world.violated("it took " + std::to_string(took.count()) + "ns instead of 1000000");
  });
  world.run();
}

// Two bugs: an update that is lost, and a store that is seen too early.
void two_bugs(World& world) {
  struct Shared {
    std::atomic<int> counter = 0;
    std::atomic<int> data = 0;
    std::atomic<bool> valid = false;
  };
  const auto shared = std::make_shared<Shared>();
  world.process("p").start("writer", [shared] {
    shared->counter = shared->counter + 1;
    shared->valid = true;
    shared->data = 7;
  });
  world.process("p").start("reader", [shared, &world] {
    shared->counter = shared->counter + 1;
    if (shared->valid && shared->data != 7) world.violated("valid before the data are there");
  });
  world.run();
  world.require(shared->counter == 2, "an increment was lost");
}

Scenario scenario_of(void (*body)(World&)) { return {"demo/minimized", "", body}; }

constexpr MinimizeOptions without_clock{.seconds_max = std::chrono::hours{1}, .executions_max = 200'000};

class MinimizerTest : public WorldTest {
 protected:
  /// The schedule of the first of the random executions of `seed` that fails.
  static Schedule failing_schedule(void (*body)(World&), std::uint64_t seed) {
    RandomStrategy strategy;
    ExploreOptions options;
    options.seed = seed;
    const ExploreReport report = Explorer{world()}.explore(scenario_of(body), strategy, options);
    return report.failures.at(0).schedule;
  }

  static MinimizeReport minimize(void (*body)(World&), const Schedule& schedule,
                                 const MinimizeOptions& options) {
    return Minimizer{world(), scenario_of(body)}.minimize(schedule, options);
  }

  static ReplayReport replay(void (*body)(World&), const Schedule& schedule) {
    return Explorer{world()}.replay(scenario_of(body), schedule, nullptr);
  }

  static void expect_one_minimal(void (*body)(World&), const Schedule& schedule) {
    EXPECT_TRUE(same_failure(replay(body, schedule).outcome, schedule));
    for (std::size_t i = 0; i < schedule.deviations.size(); ++i) {
      Schedule without_one = schedule;
      without_one.deviations.erase(without_one.deviations.begin() + static_cast<std::ptrdiff_t>(i));
      EXPECT_FALSE(same_failure(replay(body, without_one).outcome, schedule))
          << "not needed: " << to_string(schedule.deviations[i]);
    }
  }
};

struct Bug {
  const char* name;
  void (*body)(World&);
  std::size_t depth;
};

class BugTest : public MinimizerTest, public testing::WithParamInterface<Bug> {};

TEST_P(BugTest, of_depth_d_takes_at_most_d_plus_1_lines_none_of_which_can_be_left_out) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Schedule recorded = failing_schedule(GetParam().body, seed);
    const MinimizeReport report = minimize(GetParam().body, recorded, without_clock);
    ASSERT_TRUE(report.reproduced);
    EXPECT_TRUE(report.one_minimal);
    EXPECT_EQ(report.schedule.message, recorded.message);
    EXPECT_LE(report.schedule.deviations.size(), GetParam().depth + 1) << to_string(report.schedule);
    EXPECT_EQ(replay(GetParam().body, report.schedule).trace_hash, report.trace_hash);
    expect_one_minimal(GetParam().body, report.schedule);
  }
}

INSTANTIATE_TEST_SUITE_P(Depths, BugTest,
                         testing::Values(Bug{"lost_update", &lost_update, 2},
                                         Bug{"lost_wake_up", &lost_wake_up, 2},
                                         Bug{"three_half_done", &three_half_done, 3}),
                         [](const auto& bug) { return bug.param.name; });

/// The failure needs both commands, in this order, and nothing else of the input.
void stop_after_run(World& world) {
  world.process("p").start("reader", [&world] {
    const std::size_t run = world.input().find("RUN");
    if (run != std::string::npos && world.input().find("STOP", run) != std::string::npos)
      world.violated("stopped");
  });
  world.run();
}

TEST_F(MinimizerTest, takes_records_away_from_an_input_and_then_bytes) {
  Schedule schedule;
  schedule.scenario = "demo/minimized";
  schedule.outcome = OutcomeKind::invariant;
  schedule.message = "stopped";
  for (int i = 0; i < 20; ++i)
    schedule.input.push_back(i == 3 ? "xxRUNy\n" : i == 17 ? "STOPPED\n" : "noise\n");
  const MinimizeReport report = minimize(&stop_after_run, schedule, without_clock);
  ASSERT_TRUE(report.reproduced);
  EXPECT_TRUE(report.one_minimal);
  EXPECT_EQ(report.schedule.input, (std::vector<std::string>{"RUN", "STOP"}));
  EXPECT_EQ(replay(&stop_after_run, report.schedule).outcome.message, "stopped");
}

TEST_F(MinimizerTest, leaves_an_input_alone_that_does_not_fail) {
  Schedule schedule;
  schedule.scenario = "demo/minimized";
  schedule.outcome = OutcomeKind::invariant;
  schedule.message = "stopped";
  schedule.input = {"STOP\n", "RUN\n"};
  const MinimizeReport report = minimize(&stop_after_run, schedule, without_clock);
  EXPECT_FALSE(report.reproduced);
  EXPECT_EQ(report.schedule.input, schedule.input);
}

TEST_F(MinimizerTest, ends_with_the_smallest_answer_and_a_round_duration) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const MinimizeReport report = minimize(&late_answer, failing_schedule(&late_answer, seed), without_clock);
    const auto& lines = report.schedule.deviations;
    ASSERT_EQ(lines.size(), 2U) << to_string(report.schedule);
    EXPECT_EQ(lines[0].kind, Deviation::Kind::choose);
    EXPECT_EQ(lines[0].answer, 2U);
    EXPECT_EQ(lines[1].passes, 50ms) << to_string(report.schedule);  // more than 29 ms, and round
  }
}

TEST_F(MinimizerTest, the_same_schedule_gives_the_same_result) {
  const Schedule recorded = failing_schedule(&three_half_done, 1);
  const MinimizeReport one = minimize(&three_half_done, recorded, without_clock);
  const MinimizeReport other = minimize(&three_half_done, recorded, without_clock);
  EXPECT_EQ(to_string(one.schedule), to_string(other.schedule));
  EXPECT_EQ(one.executions, other.executions);
}

TEST_F(MinimizerTest, keeps_the_best_so_far_when_the_executions_are_used_up) {
  const Schedule recorded = failing_schedule(&three_half_done, 1);
  std::size_t lines_before = recorded.deviations.size();
  for (const std::uint64_t executions : {2, 10, 40, 100'000}) {
    MinimizeOptions options = without_clock;
    options.executions_max = executions;
    const MinimizeReport report = minimize(&three_half_done, recorded, options);
    ASSERT_TRUE(report.reproduced);
    EXPECT_LE(report.executions, executions + 3);
    EXPECT_LE(report.schedule.deviations.size(), lines_before);
    EXPECT_TRUE(same_failure(replay(&three_half_done, report.schedule).outcome, recorded));
    EXPECT_EQ(report.one_minimal, executions == 100'000);
    lines_before = report.schedule.deviations.size();
  }
  EXPECT_LT(lines_before, recorded.deviations.size());
}

TEST_F(MinimizerTest, without_time_the_schedule_stays_as_it_is) {
  const Schedule recorded = failing_schedule(&lost_update, 1);
  const MinimizeReport report = minimize(&lost_update, recorded, {.seconds_max = std::chrono::seconds{0}});
  EXPECT_TRUE(report.reproduced);
  EXPECT_FALSE(report.one_minimal);
  EXPECT_EQ(report.schedule.deviations, recorded.deviations);
}

TEST_F(MinimizerTest, a_schedule_that_does_not_fail_as_it_says_is_handed_back) {
  Schedule recorded = failing_schedule(&lost_update, 1);
  recorded.message = "something else";
  const MinimizeReport report = minimize(&lost_update, recorded, without_clock);
  EXPECT_FALSE(report.reproduced);
  EXPECT_EQ(report.schedule.deviations, recorded.deviations);
}

ExploreReport explore_and_minimize(World& world, void (*body)(World&), std::uint64_t executions) {
  RandomStrategy strategy;
  ExploreOptions options;
  options.executions_max = executions;
  options.keep_going = true;
  options.minimize_seconds = std::chrono::seconds{1};
  return Explorer{world}.explore(scenario_of(body), strategy, options);
}

TEST_F(MinimizerTest, two_bugs_of_one_scenario_are_two_failures) {
  const ExploreReport report = explore_and_minimize(world(), &two_bugs, 300);
  ASSERT_EQ(report.failures.size(), 2U);
  for (const Failure& failure : report.failures) {
    EXPECT_GT(failure.count, 1U);
    EXPECT_TRUE(failure.one_minimal);
    EXPECT_LE(failure.schedule.deviations.size(), 2U) << to_string(failure.schedule);
    EXPECT_EQ(failure.messages.size(), 1U);
  }
}

TEST_F(MinimizerTest, one_bug_whose_message_holds_other_numbers_each_time_is_one_failure) {
  const ExploreReport report = explore_and_minimize(world(), &takes_time, 2'000);
  ASSERT_EQ(report.failures.size(), 1U);
  EXPECT_EQ(report.failures[0].schedule.deviations.size(), 1U);
  EXPECT_GT(report.failures[0].messages.size(), 3U);
  EXPECT_GE(report.failures[0].count, report.failures[0].messages.size());
}

Failure failure_of(std::string message, std::vector<Deviation::Kind> lines) {
  Failure failure;
  failure.outcome = {OutcomeKind::invariant, std::move(message)};
  for (const Deviation::Kind kind : lines) {
    failure.schedule.deviations.emplace_back();
    failure.schedule.deviations.back().kind = kind;
  }
  return failure;
}

TEST(SameFailure, messages_that_differ_in_numbers_are_one_unless_each_needs_means_of_its_own) {
  using enum Deviation::Kind;
  const Failure lost = failure_of("request 1 is lost", {switch_task});
  EXPECT_TRUE(is_same_failure(lost, failure_of("request 2 is lost", {switch_task})));
  EXPECT_TRUE(is_same_failure(lost, failure_of("request 3 is lost", {switch_task, pass_time})));
  EXPECT_FALSE(is_same_failure(lost, failure_of("request 2 is lost", {fault})));
  EXPECT_FALSE(is_same_failure(lost, failure_of("answer 1 is lost", {switch_task})));
  EXPECT_TRUE(is_same_failure(lost, failure_of("request 1 is lost", {fault})));
}

TEST(SameFailure, numbers_that_stand_alone_vary_and_those_in_a_word_tell_apart) {
  EXPECT_EQ(without_numbers("I1: request 2 took 1534us (at 0x7fff12)"),
            without_numbers("I1: request 31 took 2us (at 0x7)"));
  EXPECT_NE(without_numbers("I1: request 2"), without_numbers("I3: request 2"));
  EXPECT_NE(without_numbers("handoff.cpp:88"), without_numbers("handoff.cpp:12"));
  EXPECT_NE(without_numbers("waits in mutex-1"), without_numbers("waits in mutex-2"));
}

TEST(AnchorWeakness, what_the_compiler_or_the_time_decides_is_weaker_than_what_the_code_says) {
  EXPECT_EQ(anchor_weakness("kernel/main before sem_wait handoff #1"), 0U);
  EXPECT_EQ(anchor_weakness("kernel/main before atomic_load segment.state #1"), 0U);
  EXPECT_EQ(anchor_weakness("kernel/main end"), 0U);
  const char* const from_strong_to_weak[] = {
      "k/m before sem_wait handoff #1", "k/m before sem_wait handoff #3", "k/m before mutex_lock mutex-1 #1",
      "k/m before read segment.a #1",   "k/m before clock_read - #1",     "k/m before atomic_load memory #1"};
  for (std::size_t i = 1; i < std::size(from_strong_to_weak); ++i)
    EXPECT_LT(anchor_weakness(from_strong_to_weak[i - 1]), anchor_weakness(from_strong_to_weak[i])) << i;
}

// Of the places where the switch does the same, all but one are references that are counted.
void counts_references(World& world) {
  const auto counter = std::make_shared<std::atomic<int>>(0);
  for (const char* name : {"one", "two"}) {
    world.process("p").start(name, [counter] {
      sem_t* const doorbell = sem_open("/doorbell", O_CREAT, 0600, 9);
      const int before = *counter;
      const std::shared_ptr<std::atomic<int>> copy = counter;
      sem_wait(doorbell);
      const std::shared_ptr<std::atomic<int>> another = counter;
      *counter = before + 1;
    });
  }
  world.run();
  world.require(*counter == 2, "an increment was lost");
}

TEST_F(MinimizerTest, of_equivalent_places_the_one_is_kept_that_survives_a_rebuild) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const MinimizeReport report =
        minimize(&counts_references, failing_schedule(&counts_references, seed), without_clock);
    ASSERT_EQ(report.schedule.deviations.size(), 1U) << to_string(report.schedule);
    EXPECT_NE(report.schedule.deviations[0].anchor.find("doorbell #1"), std::string::npos)
        << to_string(report.schedule);
  }
}

}  // namespace
}  // namespace ltsim
