// Exploration in worker processes. No World may exist in the process that explores, so this is a program of its
// own, and each World in it a short-lived one.
#include "sim_clock/explore/worker_pool.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim_clock/explore/strategies.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {
namespace {

using namespace std::chrono_literals;

std::unique_ptr<Strategy> random_strategy() { return make_strategy("random"); }

ExploreOptions at_most(std::uint64_t executions, bool keep_going = false) {
  ExploreOptions options;
  options.executions_max = executions;
  options.keep_going = keep_going;
  return options;
}

WorkerPoolReport explore(void (*body)(World&), unsigned jobs, const ExploreOptions& options,
                         WorkerPoolOptions pool = {}) {
  pool.jobs = jobs;
  return explore_in_workers({"demo/test", "", body}, random_strategy, options, pool);
}

/// All of a report that must not depend on time, as text.
std::string as_text(const WorkerPoolReport& report) {
  std::string text =
      fmt::format("{} executions, {} decisions, {} points, {} traces, {}\n", report.explored.executions,
                  report.explored.decisions, report.explored.points, report.explored.distinct_schedules,
                  report.error.value_or("no error"));
  for (const Failure& failure : report.explored.failures) {
    text += fmt::format("{} {} {:x} {:x} {} {} {}\n", failure.execution, failure.count, failure.seed,
                        failure.trace_hash, failure.outcome.message, failure.at.count(),
                        to_string(failure.schedule));
  }
  return text;
}

/// Four outcomes: passed, a lost update, and two questions answered badly.
void fails_in_three_ways(World& world) {
  const std::size_t answer = world.choose("how", 50);
  const auto counter = std::make_shared<std::atomic<int>>(0);
  for (const char* name : {"one", "two", "three"}) {
    world.process("p").start(name, [counter] { *counter = *counter + 1; });
  }
  world.run();
  world.require(answer != 7, "seven");
  world.require(answer != 8, "eight");
  world.require(answer % 2 == 0 || *counter == 3, "an increment was lost");
}

void passes(World& world) {
  world.process("p").start("main", [] { std::atomic<int>{}.store(1); });
  world.run();
}

void kills_its_process_when_asked_to(World& world) {
  if (world.choose("kill", 40) == 7) kill(getpid(), SIGKILL);
  passes(world);
}

void exits_when_asked_to(World& world) {
  if (world.choose("exit", 40) == 7) _exit(5);
  passes(world);
}

void contradicts_itself_when_asked_to(World& world) {
  if (world.choose("check", 40) == 7) _exit(3);
  passes(world);
}

void loops_without_a_scheduling_point(World& world) {
  const bool loops = world.choose("loop", 40) == 7;
  world.process("p").start("main", [loops] {
    for (volatile bool go_on = loops; go_on;) {
    }
  });
  world.run();
}

/// More than a second without a new execution, but with a scheduling point every now and then.
void is_only_slow(World& world) {
  world.process("p").start("main", [] {
    std::atomic<int> counter = 0;
    for (int step = 0; step < 12; ++step) {
      ++counter;
      const GhostScope ghost;
      const auto begin = std::chrono::steady_clock::now();
      while (std::chrono::steady_clock::now() - begin < 100ms) {
      }
    }
  });
  world.run();
}

void calls_fork_when_asked_to(World& world) {
  const bool calls = world.choose("fork", 40) == 7;
  world.process("p").start("main", [calls] {
    if (calls) static_cast<void>(fork());
  });
  world.run();
}

/// What cannot be simulated comes at once, the failure takes its time.
void fails_late_or_calls_fork(World& world) {
  const bool fails = world.choose("fail", 2) == 1;
  world.process("p").start("main", [fails] {
    if (!fails) static_cast<void>(fork());
    const GhostScope ghost;
    const auto begin = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begin < 10ms) {
    }
  });
  world.run();
  world.require(!fails, "late");
}

class WorkerPool : public testing::TestWithParam<unsigned> {};

TEST_P(WorkerPool, reports_the_first_failure_that_one_process_alone_finds) {
  const WorkerPoolReport report = explore(&fails_in_three_ways, GetParam(), at_most(1000));
  World world;
  const auto strategy = random_strategy();
  const ExploreReport alone =
      Explorer{world}.explore({"demo/test", "", &fails_in_three_ways}, *strategy, at_most(1000));
  EXPECT_EQ(as_text(report), as_text({.explored = alone, .error = {}, .abandoned = {}}));
}

TEST_P(WorkerPool, going_on_reports_and_counts_what_one_process_alone_finds) {
  const WorkerPoolReport report = explore(&fails_in_three_ways, GetParam(), at_most(1000, true));
  World world;
  const auto strategy = random_strategy();
  const ExploreReport alone =
      Explorer{world}.explore({"demo/test", "", &fails_in_three_ways}, *strategy, at_most(1000, true));
  EXPECT_EQ(report.explored.failures.size(), 3U);
  EXPECT_EQ(as_text(report), as_text({.explored = alone, .error = {}, .abandoned = {}}));
}

TEST_P(WorkerPool, equal_seeds_and_jobs_give_equal_reports) {
  for (const bool keep_going : {false, true}) {
    for (const auto body :
         {&fails_in_three_ways, &kills_its_process_when_asked_to, &calls_fork_when_asked_to}) {
      const ExploreOptions options = at_most(500, keep_going);
      // What comes after the error, and whether it still counts, depends on time.
      if (keep_going && body == &calls_fork_when_asked_to) continue;
      EXPECT_EQ(as_text(explore(body, GetParam(), options)), as_text(explore(body, GetParam(), options)));
    }
  }
}

TEST_P(WorkerPool, has_room_for_more_executions_than_there_are_records) {
  const std::uint64_t executions = WorkerProgress::records_max * GetParam() + 1000;
  EXPECT_EQ(explore(&passes, GetParam(), at_most(executions)).explored.executions, executions);
}

TEST_P(WorkerPool, a_dead_worker_loses_its_own_execution_only_and_that_is_reported) {
  const WorkerPoolReport report = explore(&kills_its_process_when_asked_to, GetParam(), at_most(1000, true));
  EXPECT_EQ(report.explored.executions, 1000U);
  EXPECT_FALSE(report.error);
  ASSERT_EQ(report.explored.failures.size(), 1U);
  const Failure& failure = report.explored.failures.front();
  EXPECT_EQ(failure.outcome, (Outcome{OutcomeKind::crash, "worker died of SIGKILL"}));
  EXPECT_EQ(failure.seed, Explorer::seed_of(1, failure.execution));
  EXPECT_FALSE(failure.has_schedule);
  EXPECT_GT(failure.count, 10U);
  EXPECT_LT(failure.count, 50U);
  EXPECT_LE(report.explored.distinct_schedules, 1000U - failure.count);
}

TEST_P(WorkerPool, what_cannot_be_simulated_ends_the_exploration) {
  const WorkerPoolReport report = explore(&calls_fork_when_asked_to, GetParam(), at_most(1000));
  ASSERT_TRUE(report.error);
  EXPECT_NE(report.error->find("fork"), std::string::npos) << *report.error;
  EXPECT_TRUE(report.explored.failures.empty());
  EXPECT_LT(report.explored.executions, 1000U);
}

TEST_P(WorkerPool, stops_when_asked_to_with_what_it_has_found) {
  std::uint64_t executions_seen = 0;
  WorkerPoolOptions pool;
  pool.on_progress = [&](const ExploreProgress& progress) {
    executions_seen = progress.executions;
    return progress.executions < 1000 || progress.failures < 3;
  };
  const WorkerPoolReport report =
      explore(&fails_in_three_ways, GetParam(), at_most(std::uint64_t{1} << 60U, true), pool);
  EXPECT_TRUE(report.stopped);
  EXPECT_GE(report.explored.executions, executions_seen);
  EXPECT_EQ(report.explored.failures.size(), 3U);
  EXPECT_TRUE(report.abandoned.empty());
}

TEST_P(WorkerPool, a_time_limit_ends_it) {
  ExploreOptions options = at_most(std::uint64_t{1} << 60U);
  options.seconds_max = 50ms;
  EXPECT_GT(explore(&passes, GetParam(), options).explored.executions, 0U);
}

INSTANTIATE_TEST_SUITE_P(Jobs, WorkerPool, testing::Values(1U, 2U, 5U),
                         [](const auto& jobs) { return fmt::format("{}", jobs.param); });

TEST(WorkerPools, a_failure_counts_although_another_worker_was_faster_with_an_error_of_a_later_execution) {
  unsigned failures_count = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    ExploreOptions options = at_most(2);
    options.seed = seed;
    const WorkerPoolReport report = explore(&fails_late_or_calls_fork, 2, options);
    EXPECT_EQ(as_text(report), as_text(explore(&fails_late_or_calls_fork, 1, options))) << "seed " << seed;
    failures_count += static_cast<unsigned>(report.explored.failures.size());
  }
  EXPECT_GT(failures_count, 1U);
  EXPECT_LT(failures_count, 8U);
}

TEST(WorkerDeaths, a_worker_that_exits_is_a_crash_and_not_the_end) {
  const WorkerPoolReport report = explore(&exits_when_asked_to, 2, at_most(1000));
  ASSERT_EQ(report.explored.failures.size(), 1U);
  EXPECT_EQ(report.explored.failures.front().outcome,
            (Outcome{OutcomeKind::crash, "worker exited with code 5"}));
}

TEST(WorkerDeaths, a_contradiction_within_the_simulator_is_an_error_and_no_finding) {
  const WorkerPoolReport report = explore(&contradicts_itself_when_asked_to, 2, at_most(1000));
  EXPECT_TRUE(report.error);
  EXPECT_TRUE(report.explored.failures.empty());
}

TEST(WorkerDeaths, an_execution_that_hangs_is_a_livelock) {
  WorkerPoolOptions pool;
  pool.hang_after = 1s;
  const WorkerPoolReport report = explore(&loops_without_a_scheduling_point, 2, at_most(1000), pool);
  ASSERT_EQ(report.explored.failures.size(), 1U);
  const Failure& failure = report.explored.failures.front();
  EXPECT_EQ(failure.outcome, (Outcome{OutcomeKind::livelock, "no scheduling point for 1 s"}));
  EXPECT_EQ(report.explored.executions, failure.execution);
}

TEST(WorkerDeaths, an_execution_that_is_only_slow_does_not_hang) {
  WorkerPoolOptions pool;
  pool.hang_after = 1s;
  const WorkerPoolReport report = explore(&is_only_slow, 1, at_most(1), pool);  // which is run twice
  EXPECT_EQ(as_text(report).find("1 executions"), 0U) << as_text(report);
  EXPECT_TRUE(report.explored.failures.empty());
}

/// The first two runs find the failure and record it; then it is made small.
void kills_whoever_looks_closer(World& world) {
  static int failures_count = 0;
  const bool fails = world.choose("fail", 20) == 7;
  if (fails && ++failures_count == 3) kill(getpid(), SIGKILL);
  passes(world);
  world.require(!fails, "seven");
}

TEST(WorkerDeaths, a_failure_that_cannot_be_made_small_is_kept_as_it_was_found) {
  ExploreOptions options = at_most(1000);
  options.minimize_seconds = 10s;
  const WorkerPoolReport report = explore(&kills_whoever_looks_closer, 2, options);
  ASSERT_EQ(report.explored.failures.size(), 1U);
  const Failure& failure = report.explored.failures.front();
  EXPECT_EQ(failure.outcome, (Outcome{OutcomeKind::invariant, "seven"}));
  EXPECT_TRUE(failure.has_schedule);
  EXPECT_EQ(failure.schedule.deviations.size(), failure.choices_count);
  EXPECT_EQ(report.explored.executions, failure.execution);
}

TEST(WorkerDeaths, who_asks_to_stop_does_not_wait_for_an_execution_that_hangs) {
  WorkerPoolOptions pool;
  pool.on_progress = [calls = 0](const ExploreProgress&) mutable { return ++calls < 3; };
  const WorkerPoolReport report = explore(
      [](World& world) {
        world.process("p").start("main", [] {
          for (volatile bool go_on = true; go_on;) {
          }
        });
        world.run();
      },
      1, at_most(1000), pool);
  EXPECT_TRUE(report.stopped);
  EXPECT_EQ(report.explored.executions, 0U);
  ASSERT_EQ(report.abandoned.size(), 1U);
  EXPECT_EQ(report.abandoned.front(), 1U);
}

}  // namespace
}  // namespace ltsim
