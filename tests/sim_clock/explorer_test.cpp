#include "sim_clock/explore/explorer.hpp"

#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "sim_clock/explore/hash_set.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

using namespace std::chrono_literals;

class ExplorerTest : public WorldTest {};

ExploreOptions at_most(std::uint64_t executions) {
  ExploreOptions options;
  options.executions_max = executions;
  return options;
}

Deviation switch_line(std::string anchor, std::string to_task) {
  Deviation line;
  line.anchor = std::move(anchor);
  line.to_task = std::move(to_task);
  return line;
}

Schedule schedule_of(std::string scenario, std::vector<Deviation> deviations) {
  Schedule schedule;
  schedule.scenario = std::move(scenario);
  schedule.deviations = std::move(deviations);
  return schedule;
}

void lost_update(World& world) {
  const auto counter = std::make_shared<std::atomic<int>>(0);
  for (const char* name : {"one", "two"}) {
    world.process("p").start(name, [counter] { *counter = *counter + 1; });
  }
  world.run();
  world.require(*counter == 2, "an increment was lost");
}

int executions_ever = 0;

void remembers_the_last_execution(World& world) {
  const auto word = std::make_shared<std::atomic<int>>(0);
  world.process("p").start("main", [word] {
    for (int i = 0; i < executions_ever; ++i) *word = i;
    ++executions_ever;
  });
  world.run();
}

void initialises_on_first_use(World& world) {
  world.process("p").start("main", [] {
    static const int sum = [] {
      std::atomic<int> counter = 0;
      for (int i = 0; i < 5; ++i) ++counter;
      return counter.load();
    }();
    std::atomic<int> copy = sum;
    ++copy;
  });
  world.run();
}

void asks_for_a_number(World& world) {
  world.require(world.choose("number", 5) != 3, "three");
  world.run();
}

TEST_F(ExplorerTest, finds_a_lost_update_and_its_schedule_replays_it) {
  const Scenario scenario{"demo/lost-update", "", &lost_update};
  Explorer explorer{world()};
  RandomStrategy strategy;
  const ExploreReport report = explorer.explore(scenario, strategy, at_most(100));
  ASSERT_EQ(report.failures.size(), 1U);
  const Failure& failure = report.failures.front();
  EXPECT_EQ(failure.outcome, (Outcome{OutcomeKind::invariant, "an increment was lost"}));
  EXPECT_EQ(failure.execution, report.executions);
  EXPECT_FALSE(failure.schedule.deviations.empty());
  const ReplayReport replayed = explorer.replay(scenario, failure.schedule, nullptr);
  EXPECT_EQ(replayed.outcome, failure.outcome);
  EXPECT_EQ(replayed.trace_hash, failure.trace_hash);
  EXPECT_FALSE(replayed.divergence);
}

TEST_F(ExplorerTest, the_default_schedule_passes_where_only_a_switch_fails) {
  const Scenario scenario{"demo/lost-update", "", &lost_update};
  const ReplayReport replayed =
      Explorer{world()}.replay(scenario, schedule_of("demo/lost-update", {}), nullptr);
  EXPECT_TRUE(replayed.outcome.passed());
}

TEST_F(ExplorerTest, going_on_reports_each_different_failure_once_with_its_count) {
  const Scenario scenario{"demo/lost-update", "", &lost_update};
  RandomStrategy strategy;
  ExploreOptions options = at_most(200);
  options.keep_going = true;
  const ExploreReport report = Explorer{world()}.explore(scenario, strategy, options);
  EXPECT_EQ(report.executions, 200U);
  ASSERT_EQ(report.failures.size(), 1U);
  EXPECT_GT(report.failures.front().count, 10U);
  EXPECT_LT(report.failures.front().count, 190U);
  EXPECT_GT(report.distinct_schedules, 1U);
}

TEST_F(ExplorerTest, choices_of_the_scenario_are_explored_recorded_and_replayed) {
  const Scenario scenario{"demo/asks", "", &asks_for_a_number};
  Explorer explorer{world()};
  RandomStrategy strategy;
  const ExploreReport report = explorer.explore(scenario, strategy, at_most(100));
  ASSERT_EQ(report.failures.size(), 1U);
  const auto& deviations = report.failures.front().schedule.deviations;
  ASSERT_EQ(deviations.size(), 1U);
  EXPECT_EQ(deviations.front().anchor, "- asks number #1");
  EXPECT_EQ(deviations.front().answer, 3U);
  EXPECT_EQ(explorer.replay(scenario, report.failures.front().schedule, nullptr).outcome.message, "three");
}

TEST_F(ExplorerTest, a_variable_that_survives_an_execution_stops_the_exploration_and_the_step_is_named) {
  const Scenario scenario{"demo/remembers", "", &remembers_the_last_execution};
  RandomStrategy strategy;
  try {
    static_cast<void>(Explorer{world()}.explore(scenario, strategy, at_most(100)));
    FAIL() << "two runs of a seed differ and nobody noticed";
  } catch (const Explorer::NotSimulable& error) {
    EXPECT_NE(error.message.find("demo/remembers differ"), std::string::npos) << error.message;
    EXPECT_NE(error.message.find("atomic_store"), std::string::npos) << error.message;
  }
}

TEST_F(ExplorerTest, what_is_initialised_on_first_use_is_no_surviving_variable) {
  const Scenario scenario{"demo/first-use", "", &initialises_on_first_use};
  RandomStrategy strategy;
  EXPECT_EQ(Explorer{world()}.explore(scenario, strategy, at_most(10)).executions, 10U);
}

TEST_F(ExplorerTest, a_scenario_that_forgets_to_run_is_told_so) {
  const Scenario scenario{"demo/forgets", "", [](World& world) { world.process("p").start("main", [] {}); }};
  RandomStrategy strategy;
  EXPECT_THROW(static_cast<void>(Explorer{world()}.explore(scenario, strategy, at_most(10))),
               Explorer::NotSimulable);
}

TEST_F(ExplorerTest, names_with_blanks_and_questions_of_tasks_survive_the_way_through_a_file) {
  const Scenario scenario{"demo/blanks", "", [](World& world) {
                            world.process("cnc kernel").start("main task", [&world] {
                              world.require(world.choose("how many", 3) != 2, "two");
                            });
                            world.run();
                          }};
  Explorer explorer{world()};
  RandomStrategy strategy;
  const ExploreReport report = explorer.explore(scenario, strategy, at_most(100));
  ASSERT_EQ(report.failures.size(), 1U);
  const auto schedule = parse_schedule(to_string(report.failures.front().schedule));
  ASSERT_TRUE(schedule) << schedule.error().reason;
  EXPECT_EQ(schedule->deviations.front().anchor, "cnc_kernel/main_task asks how_many #1");
  EXPECT_EQ(explorer.replay(scenario, *schedule, nullptr).outcome.message, "two");
}

TEST_F(ExplorerTest, a_call_that_is_not_simulated_stops_the_exploration_and_is_named) {
  const Scenario scenario{"demo/fork", "", [](World& world) {
                            world.process("p").start("main", [] { static_cast<void>(fork()); });
                            world.run();
                          }};
  RandomStrategy strategy;
  EXPECT_THROW(
      {
        try {
          static_cast<void>(Explorer{world()}.explore(scenario, strategy, at_most(100)));
        } catch (const Explorer::NotSimulable& error) {
          EXPECT_NE(error.message.find("fork"), std::string::npos) << error.message;
          throw;
        }
      },
      Explorer::NotSimulable);
}

TEST_F(ExplorerTest, a_line_whose_place_is_never_reached_is_named) {
  const Scenario scenario{"demo/lost-update", "", &lost_update};
  const Schedule schedule =
      schedule_of("demo/lost-update", {switch_line("p/one before atomic_load memory #1", "p/two"),
                                       switch_line("p/one before sem_wait handoff #1", "p/two")});
  const ReplayReport report = Explorer{world()}.replay(scenario, schedule, nullptr);
  ASSERT_TRUE(report.divergence);
  EXPECT_EQ(report.divergence->deviation, &schedule.deviations[1]);
  EXPECT_NE(report.divergence->reason.find("never came"), std::string::npos);
}

TEST_F(ExplorerTest, a_line_whose_task_cannot_run_there_is_named) {
  const Scenario scenario{"demo/lost-update", "", &lost_update};
  const Schedule schedule =
      schedule_of("demo/lost-update", {switch_line("p/one before atomic_load memory #1", "p/three")});
  const ReplayReport report = Explorer{world()}.replay(scenario, schedule, nullptr);
  ASSERT_TRUE(report.divergence);
  EXPECT_NE(report.divergence->reason.find("cannot run"), std::string::npos);
}

TEST_F(ExplorerTest, a_slow_moment_of_one_task_lets_the_others_go_on) {
  const Scenario scenario{"demo/slow", "", [](World& world) {
                            const auto finished = std::make_shared<SimTime>();
                            world.process("p").start("slow", [] { static_cast<void>(time(nullptr)); });
                            world.process("p").start("quick", [finished, &world] {
                              std::this_thread::sleep_for(5ms);
                              *finished = world.now();
                            });
                            world.run();
                            world.require(*finished < 6ms && world.now() >= 10ms,
                                          "quick was not held up, slow was");
                          }};
  Deviation stall;
  stall.kind = Deviation::Kind::stall;
  stall.anchor = "p/slow before clock_read - #1";
  stall.passes = 10ms;
  const Schedule schedule = schedule_of("demo/slow", {switch_line("- start", "p/quick"), stall});
  const ReplayReport report = Explorer{world()}.replay(scenario, schedule, nullptr);
  EXPECT_EQ(report.outcome, Outcome{});
  EXPECT_FALSE(report.divergence) << report.divergence->reason;
}

TEST_F(ExplorerTest, choices_during_and_after_a_slow_moment_of_a_task_have_places_of_their_own) {
  const Scenario scenario{"demo/slow", "", [](World& world) {
                            world.process("p").start("slow", [] {
                              static_cast<void>(time(nullptr));
                              static_cast<void>(time(nullptr));
                            });
                            for (const char* name : {"one", "two"}) {
                              world.process("p").start(name, [] {
                                std::this_thread::sleep_for(5ms);
                                static_cast<void>(time(nullptr));
                                std::this_thread::sleep_for(5ms);
                              });
                            }
                            world.run();
                            world.violated("to have a schedule");
                          }};
  Explorer explorer{world()};
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RandomStrategy strategy;
    const Failure recorded = explorer.record(scenario, strategy, seed);
    const ReplayReport replayed = explorer.replay(scenario, recorded.schedule, nullptr);
    ASSERT_EQ(replayed.trace_hash, recorded.trace_hash) << to_string(recorded.schedule);
    ASSERT_FALSE(replayed.divergence) << to_string(recorded.schedule);
  }
}

/// Fails wherever two tasks without a lock can overlap, so not on one processor if both have a priority.
void overlaps(World& world) {
  const auto inside = std::make_shared<std::atomic<int>>(0);
  for (const char* name : {"one", "two"}) {
    world.process("p").start(name, [inside, &world] {
      const sched_param parameters{.sched_priority = 5};
      pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
      world.require(++*inside == 1, "two are inside");
      --*inside;
    });
  }
  world.run();
}

TEST_F(ExplorerTest, one_processor_is_an_option_of_the_exploration_and_stands_in_its_schedules) {
  const Scenario scenario{"demo/overlaps", "", &overlaps};
  RandomStrategy strategy;
  ExploreOptions options = at_most(200);
  const ExploreReport on_many = Explorer{world()}.explore(scenario, strategy, options);
  ASSERT_EQ(on_many.failures.size(), 1U);
  options.cpu = Cpu::one_fifo;
  EXPECT_TRUE(Explorer{world()}.explore(scenario, strategy, options).failures.empty());
  // The schedule brings its own machine along.
  EXPECT_EQ(Explorer{world()}.replay(scenario, on_many.failures.front().schedule, nullptr).outcome.message,
            "two are inside");
}

TEST(HashSet, counts_different_values_up_to_its_bound) {
  HashSet set{5000};
  for (int round = 0; round < 2; ++round) {
    for (std::uint64_t i = 0; i < 3000; ++i) set.insert(i * 0x9e3779b97f4a7c15U);
  }
  EXPECT_EQ(set.size(), 3000U);
  for (std::uint64_t i = 0; i < 9000; ++i) set.insert(i * 0x9e3779b97f4a7c15U);
  EXPECT_EQ(set.size(), 5000U);
}

}  // namespace
}  // namespace ltsim
