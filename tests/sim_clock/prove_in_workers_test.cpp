// A proof in worker processes: the report is that of one process. No World may exist in the process that proves.
#include "sim_clock/explore/prove_in_workers.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim_clock/explore/proof_file.hpp"
#include "tests/sim_clock/known_traces.hpp"

namespace ltsim {
namespace {

using namespace std::chrono_literals;
using Word = std::atomic<std::uint32_t>;

bool goes_on(const ProveReport& /*so_far*/) { return true; }

ProveReport prove_alone(const std::function<void(World&)>& body, const ProveOptions& options = {}) {
  World world;
  return Prover{world}.prove({.name = "test/proved", .description = "", .body = body}, options, {}, goes_on);
}

/// With slices so short that all is split that can be.
ProveReport prove(const std::function<void(World&)>& body, unsigned jobs, const ProveOptions& options = {},
                  const ProveReport& earlier = {}, const ProveProgress& on_progress = goes_on) {
  return prove_in_workers({.name = "test/proved", .description = "", .body = body}, options,
                          {.jobs = jobs, .slice = 0s}, earlier, on_progress);
}

/// All of a report that must not depend on time, as text.
std::string as_text(const ProveReport& report) {
  std::string text =
      fmt::format("{}, {} redundant, {} held back, {} points, {}, {}\n", describe_coverage(report, {}),
                  report.counts.redundant, report.counts.held_back, report.counts.points,
                  report.complete ? "complete" : "not complete", report.error.value_or("no error"));
  if (report.failure)
    text += fmt::format("execution {} fails: {}\n{}", report.failure->execution,
                        report.failure->outcome.message, to_string(report.failure->schedule));
  return text;
}

void lost_update(World& world) {
  Word word{0};
  start_tasks(world, 3, [&](std::uint32_t) {
    for (int i = 0; i < 2; ++i) word.fetch_add(1);
    word.store(word.load() + 1);
  });
  world.run();
  world.require(word.load() == 9, "an update is lost");
}

class ProveInWorkers : public testing::TestWithParam<unsigned> {};

TEST_P(ProveInWorkers, all_that_is_counted_of_programs_with_known_traces_is_what_one_process_counts) {
  for (const Known& known : known_programs()) {
    if (known.traces > 3000) continue;
    const ProveReport report = prove(known.body, GetParam());
    EXPECT_EQ(report.counts.executions, known.traces) << known.name;
    EXPECT_EQ(as_text(report), as_text(prove_alone(known.body))) << known.name;
  }
}

TEST_P(ProveInWorkers, with_a_bound_on_preemptions_too) {
  ProveOptions options;
  options.bounds.preemptions = 2;
  // Of many tasks all orders are run, also those that make no difference.
  const std::set<std::string> of_few_tasks{"two_counters_5", "three_counters_2", "tokens_5", "last_zero_1",
                                           "store_buffering"};
  std::size_t proved = 0;
  for (const Known& known : known_programs()) {
    if (!of_few_tasks.contains(known.name)) continue;
    ++proved;
    EXPECT_EQ(as_text(prove(known.body, GetParam(), options)), as_text(prove_alone(known.body, options)))
        << known.name;
  }
  EXPECT_EQ(proved, of_few_tasks.size());
}

TEST_P(ProveInWorkers, the_failure_is_that_which_one_process_finds_first) {
  for (const double minimize_seconds : {0.0, 1.0}) {
    ProveOptions options;
    options.minimize_seconds = std::chrono::duration<double>{minimize_seconds};
    const ProveReport report = prove(&lost_update, GetParam(), options);
    ASSERT_TRUE(report.failure);
    EXPECT_FALSE(report.complete);
    EXPECT_EQ(as_text(report), as_text(prove_alone(&lost_update, options)));
  }
}

TEST_P(ProveInWorkers, interrupted_again_and_again_it_comes_to_the_same) {
  const Known program = last_zero(8);
  const std::string whole = as_text(prove_alone(program.body));
  ProveOptions options;
  options.seconds_max = 5ms;
  ProveReport part;
  unsigned interruptions = 0;
  for (; !part.complete && interruptions < 2000; ++interruptions) {
    // Now by so many workers, now by none.
    if (interruptions % 3 == 2) {
      World world;
      part = Prover{world}.prove({.name = "test/proved", .description = "", .body = program.body}, options,
                                 part, goes_on);
    } else {
      part = prove(program.body, GetParam(), options, part);
    }
    ASSERT_EQ(part.error, std::nullopt);
    if (part.complete) break;
    const auto read = parse_proof(to_proof(part, "test/proved", {}), "test/proved", {});
    ASSERT_TRUE(read) << read.error();
    EXPECT_EQ(read->counts, part.counts);
    part = *read;
  }
  EXPECT_GT(interruptions, 0U);
  EXPECT_EQ(as_text(part), whole);
}

TEST_P(ProveInWorkers, what_cannot_be_simulated_is_an_error) {
  const auto body = [](World& world) {
    const bool calls = world.choose("fork", 40) == 7;
    world.process("p").start("main", [calls] {
      if (calls) static_cast<void>(fork());
    });
    world.run();
  };
  EXPECT_EQ(as_text(prove(body, GetParam())), as_text(prove_alone(body)));
  EXPECT_NE(prove(body, GetParam()).error.value_or("").find("fork"), std::string::npos);
}

TEST_P(ProveInWorkers, a_machine_of_one_processor_is_refused) {
  const ProveReport report = prove(
      [](World& world) {
        world.set_cpu(Cpu::one_fifo);
        world.run();
      },
      GetParam());
  EXPECT_NE(report.error.value_or("").find("one processor"), std::string::npos);
}

TEST_P(ProveInWorkers, of_a_worker_that_dies_what_it_was_at_stays_to_be_done) {
  const pid_t parent = getpid();
  const auto body = [&](bool kills) {
    return [kills, parent](World& world) {
      if (world.choose("kill", 40) == 7 && kills && getpid() != parent) kill(getpid(), SIGKILL);
      Word word{0};
      start_tasks(world, 2, [&](std::uint32_t) { word.fetch_add(1); });
      world.run();
    };
  };
  const ProveReport died = prove(body(true), GetParam());
  EXPECT_EQ(died.error.value_or("").find("a worker process died of SIGKILL"), 0U) << died.error.value_or("");
  EXPECT_FALSE(died.complete);
  EXPECT_LT(died.counts.executions, 80U);
  const auto read = parse_proof(to_proof(died, "test/proved", {}), "test/proved", {});
  ASSERT_TRUE(read);
  const ProveReport rest = prove(body(false), GetParam(), {}, *read);
  EXPECT_TRUE(rest.complete);
  EXPECT_EQ(rest.counts.executions, 80U);
}

TEST_P(ProveInWorkers, who_asks_to_stop_does_not_wait_for_an_execution_that_hangs) {
  // The first run is the one that warms up.
  const auto body = [](World& world) {
    static int runs = 0;
    const bool hangs = ++runs > 1;
    world.process("p").start("main", [hangs] {
      for (volatile bool go_on = hangs; go_on;) {
      }
    });
    world.run();
  };
  const ProveReport report =
      prove(body, GetParam(), {}, {}, [calls = 0](const ProveReport&) mutable { return ++calls < 3; });
  EXPECT_FALSE(report.complete);
  EXPECT_EQ(report.error, std::nullopt);
}

TEST(ProofInWorkers, initialises_on_first_use_before_it_writes_a_failure_down) {
  const auto body = [](World& world) {
    static bool is_initialised = false;
    if (!std::exchange(is_initialised, true)) static_cast<void>(world.choose("at first", 3));
    lost_update(world);
  };
  const ProveReport report = prove(body, 2);  // the first one in this process
  EXPECT_EQ(as_text(report), as_text(prove_alone(body)));
  ASSERT_TRUE(report.failure);
  EXPECT_EQ(report.failure->outcome.message, "an update is lost");
}

TEST(ProofInWorkers, that_is_stopped_tells_a_failure_that_was_found_in_a_later_part) {
  const auto body = [](World& world) {
    const bool fails = world.choose("fails", 2) == 1;
    if (!fails) return last_zero(14).body(world);
    world.run();
    world.require(!fails, "failed");
  };
  const ProveReport report =
      prove(body, 2, {}, {}, [calls = 0](const ProveReport&) mutable { return ++calls < 4; });
  ASSERT_TRUE(report.failure);
  EXPECT_EQ(report.failure->outcome.message, "failed");
}

INSTANTIATE_TEST_SUITE_P(Jobs, ProveInWorkers, testing::Values(1U, 2U, 3U),
                         [](const auto& jobs) { return fmt::format("{}", jobs.param); });

}  // namespace
}  // namespace ltsim
