// Exhaustive search: programs whose number of Mazurkiewicz traces is known by hand or formula, what a bound on preemptions covers,
// and what a proof says and leaves behind.
#include "sim_clock/explore/prover.hpp"

#include <fcntl.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/explore/proof_file.hpp"
#include "tests/sim_clock/known_traces.hpp"
#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

using Word = std::atomic<std::uint32_t>;

class ProverTest : public WorldTest {
 protected:
  static ProveReport prove(const std::function<void(World&)>& body, const ProveOptions& options = {},
                           const ProveReport& earlier = {},
                           std::uint64_t executions_max = ~std::uint64_t{0}) {
    const Scenario scenario{.name = "test/proved", .description = "", .body = body};
    return Prover{world()}.prove(scenario, options, earlier, [&](const ProveReport& so_far) {
      return so_far.counts.executions < executions_max;
    });
  }
};

class KnownTracesTest : public ProverTest, public testing::WithParamInterface<Known> {};

TEST_P(KnownTracesTest, are_all_run_and_hardly_anything_else) {
  const ProveReport report = prove(GetParam().body);
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.error, std::nullopt);
  EXPECT_EQ(report.counts.executions, GetParam().traces);
  EXPECT_LE(2 * (report.counts.executions + report.counts.redundant), 3 * GetParam().traces);
}

INSTANTIATE_TEST_SUITE_P(Programs, KnownTracesTest, testing::ValuesIn(known_programs()),
                         [](const auto& known) { return known.param.name; });

void two_counters_of_their_own(World& world, std::uint32_t steps) {
  std::array<Word, 2> words{};
  start_tasks(world, 2, [&](std::uint32_t i) {
    for (std::uint32_t k = 0; k < steps; ++k) words[i].fetch_add(1);
  });
  world.run();
}

TEST_F(ProverTest, with_a_bound_on_preemptions_all_schedules_within_it_are_run) {
  const auto executions = [](unsigned preemptions) {
    ProveOptions options;
    options.bounds.preemptions = preemptions;
    return prove([](World& world) { two_counters_of_their_own(world, 3); }, options).counts.executions;
  };
  EXPECT_EQ(executions(0), 2U);
  // One switch after the first or second of the three steps of whoever begins: each task then ends at once, or after the other.
  EXPECT_EQ(executions(1), 2U + 2 * 2U);
  EXPECT_EQ(executions(100), choose(6, 3));
}

TEST_F(ProverTest, without_a_bound_orders_that_make_no_difference_are_one) {
  EXPECT_EQ(prove([](World& world) { two_counters_of_their_own(world, 3); }).counts.executions, 1U);
}

ProveOptions by_states() {
  ProveOptions options;
  options.bounds = {.preemptions = {}, .silences = 0U, .states = true};
  return options;
}

/// What is left of the way into a state, on stacks, in registers, in freed memory, does not make another state of it.
TEST_F(ProverTest, states_are_as_few_as_they_are) {
  constexpr std::uint32_t steps = 12;
  const ProveReport report = prove(
      [](World& of) {
        Word word{0};
        start_tasks(of, 2, [&](std::uint32_t) {
          for (std::uint32_t k = 0; k < steps; ++k) {
            // Blocks of the heap lie elsewhere in each execution.
            auto counter = std::make_unique<std::vector<std::uint32_t>>(k + 1, 0U);
            counter->back() = word.fetch_xor(1);
          }
        });
        of.run();
        of.require(word.load() == 0, "an update is lost");
      },
      by_states());
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.error, std::nullopt);
  // How far each is, and what it has found last; of the 2.7 million ways there.
  EXPECT_GE(report.states, (steps - 1) * (steps - 1));
  EXPECT_LE(report.states, 6 * (steps + 1) * (steps + 1));
}

/// Nobody can come to the memory of a process that was killed: how far it was, does not make another state.
TEST_F(ProverTest, what_a_killed_process_has_left_on_the_heap_is_no_state) {
  constexpr std::uint32_t steps = 12;
  const auto states = [](unsigned kills) {
    const ProveReport report = prove(
        [kills](World& of) {
          Word word{0};
          of.process("killed").start("main", [&] {
            const auto progress = std::make_unique<std::vector<std::uint32_t>>(8, 0U);
            for (std::uint32_t k = 0; k < steps; ++k) {
              progress->front() = k;
              static_cast<void>(word.load());
            }
          });
          of.process("lives").start("main", [&] {
            for (std::uint32_t k = 0; k < steps; ++k) static_cast<void>(word.load());
          });
          if (kills != 0) of.process("killed").may_crash({.times = kills, .restart_after = {}});
          of.run();
        },
        by_states());
    EXPECT_TRUE(report.complete);
    return report.states;
  };
  EXPECT_LE(states(1), states(0) + 4 * (steps + 1));
}

/// Where it stood when it was killed, and when its next life began, decide nothing once that has ended.
TEST_F(ProverTest, when_and_where_a_process_was_killed_is_no_state) {
  constexpr unsigned sleeps = 4;
  const auto states = [](unsigned kills) {
    const ProveReport report = prove(
        [kills](World& of) {
          Word word{0};
          of.process("killed").start("main", [] {
            for (unsigned k = 0; k < sleeps; ++k) std::this_thread::sleep_for(std::chrono::milliseconds{1});
          });
          for (const char* const name : {"one", "other"}) {
            of.process("lives").start(name, [&] {
              std::this_thread::sleep_for(std::chrono::seconds{1});
              for (unsigned k = 0; k < 8; ++k) word.fetch_xor(1);
            });
          }
          if (kills != 0)
            of.process("killed").may_crash({.times = kills, .restart_after = std::chrono::milliseconds{1}});
          of.run();
        },
        by_states());
    EXPECT_TRUE(report.complete);
    EXPECT_EQ(report.error, std::nullopt);
    return report.states;
  };
  const std::uint64_t without = states(0);
  EXPECT_GT(without, 64U);
  // If the time of each of its steps counted, there would be six times as many, and more.
  EXPECT_LE(states(1), 4 * without);
}

void* map_segment() {
  const int descriptor = shm_open("/segment", O_RDWR, 0600);
  void* const address = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  close(descriptor);
  return address;
}

/// What is to be loaded once in a transaction: that ends with its task.
TEST_F(ProverTest, what_a_killed_process_has_loaded_is_no_state) {
  const auto states = [](bool loads_once) {
    const ProveReport report = prove(
        [loads_once](World& of) {
          const std::array<std::byte, 4096> zeros{};
          of.leave_segment("segment", zeros);
          if (loads_once) of.single_fetch("segment", 8, 4, "segment.length");
          Word word{0};
          of.process("killed").start("main", [] {
            static_cast<void>(static_cast<Word*>(map_segment())[2].load());
            std::this_thread::yield();
          });
          of.process("lives").start("main", [&] {
            for (std::uint32_t k = 0; k < 12; ++k) word.fetch_add(1);
          });
          of.process("killed").may_crash({.times = 1, .restart_after = {}});
          of.run();
        },
        by_states());
    EXPECT_TRUE(report.complete);
    EXPECT_EQ(report.error, std::nullopt);
    return report.states;
  };
  EXPECT_EQ(states(true), states(false));
}

/// Neither is how many steps there have been while a task stood before its access to a segment.
TEST_F(ProverTest, how_long_a_task_has_stood_before_an_access_is_no_state) {
  constexpr std::uint32_t steps = 12;
  const ProveReport report = prove(
      [](World& of) {
        const std::array<std::byte, 4096> zeros{};
        of.leave_segment("segment", zeros);
        start_tasks(of, 2, [](std::uint32_t i) {
          Word* const words = static_cast<Word*>(map_segment());
          for (std::uint32_t k = 0; k < steps; ++k) words[i].store(k);
        });
        of.run();
      },
      by_states());
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.error, std::nullopt);
  constexpr std::uint32_t steps_to_map = 3;  // shm_open, mmap, close
  EXPECT_LE(report.states, 2 * (steps + steps_to_map + 1) * (steps + steps_to_map + 1));
}

/// A mapping that goes while a task stands before its access is looked for when it goes on.
TEST_F(ProverTest, an_access_behind_an_unmapping_is_found_where_states_are_told_apart) {
  const ProveReport report = prove(
      [](World& of) {
        const std::array<std::byte, 4096> zeros{};
        of.leave_segment("segment", zeros);
        Word is_mapped{0};
        void* segment = nullptr;
        of.process("program").start("one", [&] {
          segment = map_segment();
          is_mapped.store(1);
          static_cast<Word*>(segment)->store(1);
        });
        of.process("program").start("other", [&] {
          if (is_mapped.load() == 1) munmap(segment, 4096);
        });
        of.run();
      },
      by_states());
  ASSERT_TRUE(report.failure);
  EXPECT_EQ(report.failure->outcome.kind, OutcomeKind::crash);
}

TEST_F(ProverTest, a_failure_that_a_check_remembers_is_found_where_states_are_told_apart) {
  // Both tasks end in the same state whoever was first; only the check knows.
  const ProveReport report = prove(
      [](World& of) {
        Word word{0};
        std::vector<std::uint32_t> order;
        start_tasks(of, 2, [&](std::uint32_t i) {
          word.store(0);
          order.push_back(i);
        });
        of.run();
        of.require(order.front() == 0, "task-1 was first");
      },
      by_states());
  ASSERT_TRUE(report.failure);
  EXPECT_EQ(report.failure->outcome.message, "task-1 was first");
}

/// Once both have ended, only the semaphore knows which of them came first.
TEST_F(ProverTest, a_token_that_was_left_is_another_state) {
  const ProveReport report = prove(
      [](World& of) {
        std::array<Word, 2> done{};
        of.leave_semaphore("tokens", 0);
        start_tasks(of, 2, [&](std::uint32_t i) {
          sem_t* const tokens = sem_open("tokens", 0);
          static_cast<void>(i == 0 ? sem_post(tokens) : sem_trywait(tokens));
          done[i].store(1);
        });
        of.process("program").start("checker", [&] {
          sem_t* const tokens = sem_open("tokens", 0);
          if (done[0].load() == 0 || done[1].load() == 0) return;
          int count = 0;
          sem_getvalue(tokens, &count);
          of.require(count == 0, "a token is left");
        });
        of.run();
      },
      by_states());
  ASSERT_TRUE(report.failure);
  EXPECT_EQ(report.failure->outcome.message, "a token is left");
}

TEST_F(ProverTest, a_search_by_states_that_goes_on_says_that_it_has_runs) {
  const Known program = last_zero(5);
  const ProveReport whole = prove(program.body, by_states());
  const ProveReport part = prove(program.body, by_states(), {}, 1);
  ASSERT_FALSE(part.complete);
  const auto read = parse_proof(to_proof(part, "test/proved", by_states()), "test/proved", by_states());
  ASSERT_TRUE(read) << read.error();
  const ProveReport rest = prove(program.body, by_states(), *read);
  EXPECT_TRUE(rest.complete);
  EXPECT_GE(rest.states, whole.states);
  EXPECT_TRUE(describe_coverage(rest, by_states())
                  .starts_with(fmt::format("all {} states, told apart in 2 runs, in {} executions",
                                           rest.states, rest.counts.executions)));
}

TEST_F(ProverTest, a_task_that_polls_is_no_way_without_end_where_states_are_told_apart) {
  const ProveReport report = prove(
      [](World& of) {
        Word word{0};
        start_tasks(of, 2, [&](std::uint32_t i) {
          if (i == 1) {
            word.store(1);
          } else {
            while (word.load() == 0) {
            }
          }
        });
        of.run();
      },
      by_states());
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.counts.cut_off, 0U);
  EXPECT_EQ(report.counts.held_back, 0U);
  EXPECT_LT(report.states, 20U);
}

TEST_F(ProverTest, memory_that_is_no_part_of_the_state_is_refused) {
  const auto elsewhere = std::make_unique<std::uint32_t>(0);
  const ProveReport report = prove(
      [&](World& of) {
        Word word{0};
        *elsewhere = 0;
        start_tasks(of, 2, [&](std::uint32_t i) {
          word.store(i);
          *elsewhere += i;
        });
        of.run();
      },
      by_states());
  EXPECT_NE(report.error.value_or("").find("memory that does not belong"), std::string::npos);
}

TEST_F(ProverTest, states_of_weak_memory_are_refused) {
  ProveOptions options = by_states();
  options.memory = Memory::c11;
  const ProveReport report = prove([](World& of) { two_counters_of_their_own(of, 2); }, options);
  EXPECT_NE(report.error.value_or("").find("memory sc only"), std::string::npos);
}

TEST_F(ProverTest, the_first_failure_ends_the_search_and_can_be_replayed) {
  const auto lost_update = [](World& of) {
    Word word{0};
    start_tasks(of, 2, [&](std::uint32_t) { word.store(word.load() + 1); });
    of.run();
    of.require(word.load() == 2, "an update is lost");
  };
  ProveOptions options;
  options.minimize_seconds = std::chrono::seconds{1};
  const ProveReport report = prove(lost_update, options);
  ASSERT_TRUE(report.failure);
  EXPECT_FALSE(report.complete);
  EXPECT_EQ(report.failure->schedule.deviations.size(), 1U);
  const Scenario scenario{.name = "test/proved", .description = "", .body = lost_update};
  EXPECT_EQ(Explorer{world()}.replay(scenario, report.failure->schedule, nullptr).outcome.message,
            "an update is lost");
}

TEST_F(ProverTest, a_time_out_meets_a_late_peer_only_in_a_silence) {
  const auto answered_in_time = [](World& of) {
    of.leave_semaphore("answer", 0);
    int error = 0;
    of.process("kernel").start("main", [&] {
      timespec until{};
      clock_gettime(CLOCK_REALTIME, &until);
      until.tv_sec += 1;
      error = sem_timedwait(sem_open("answer", 0), &until);
    });
    of.process("emulator").start("main", [] { sem_post(sem_open("answer", 0)); });
    of.run();
    of.require(error == 0, "no answer in time");
  };
  EXPECT_TRUE(prove(answered_in_time).complete);
  ProveOptions options;
  options.bounds.preemptions = 1;
  EXPECT_TRUE(prove(answered_in_time, options).complete);
  options.bounds.silences = 1;
  EXPECT_TRUE(prove(answered_in_time, options).failure);
}

TEST_F(ProverTest, what_is_not_over_goes_on_from_its_checkpoint) {
  const Known program = last_zero(9);
  const ProveReport whole = prove(program.body);
  const ProveReport part = prove(program.body, {}, {}, 1);
  ASSERT_FALSE(part.complete);
  EXPECT_GT(part.done, 0);
  const std::string file = to_proof(part, "test/proved", {});
  const auto read = parse_proof(file, "test/proved", {});
  ASSERT_TRUE(read) << read.error();
  const ProveReport rest = prove(program.body, {}, *read);
  EXPECT_TRUE(rest.complete);
  EXPECT_EQ(rest.counts.executions, whole.counts.executions);
  EXPECT_EQ(rest.counts.redundant, whole.counts.redundant);
}

TEST_F(ProverTest, a_checkpoint_belongs_to_its_search) {
  ProveReport part;
  part.checkpoint = SearchTree{}.checkpoint();
  const std::string file = to_proof(part, "test/proved", {});
  ProveOptions weak;
  weak.memory = Memory::c11;
  EXPECT_FALSE(parse_proof(file, "test/proved", weak));
  EXPECT_FALSE(parse_proof(file, "test/another", {}));
  // Within equal bounds, too.
  ProveOptions bounded;
  bounded.bounds.preemptions = 1;
  ProveOptions bounded_by_states = bounded;
  bounded_by_states.bounds.states = true;
  EXPECT_TRUE(parse_proof(to_proof(part, "test/proved", bounded), "test/proved", bounded));
  EXPECT_FALSE(parse_proof(to_proof(part, "test/proved", bounded), "test/proved", bounded_by_states));
  EXPECT_FALSE(parse_proof("something else", "test/proved", {}));
  part.checkpoint = "nonsense\n";
  EXPECT_NE(prove(last_zero(1).body, {}, part).error, std::nullopt);
}

TEST_F(ProverTest, a_program_that_keeps_something_from_one_execution_to_the_next_is_refused) {
  static std::uint32_t survives = 0;
  const ProveReport report = prove([](World& of) {
    Word word{0};
    ++survives;
    start_tasks(of, 2, [&](std::uint32_t i) {
      for (std::uint32_t k = 0; k < (survives < 4 || i == 1 ? 3U : 0U); ++k) word.fetch_add(1);
    });
    of.run();
  });
  EXPECT_NE(report.error.value_or("").find("survives"), std::string::npos);
}

TEST_F(ProverTest, a_machine_of_one_processor_is_refused) {
  const ProveReport report = prove([](World& of) {
    of.set_cpu(Cpu::one_fifo);
    two_counters_of_their_own(of, 2);
  });
  EXPECT_FALSE(report.complete);
  EXPECT_NE(report.error.value_or("").find("one processor"), std::string::npos);
}

TEST_F(ProverTest, an_execution_without_end_is_counted_as_cut_off) {
  const ProveReport report = prove([](World& of) {
    Word word{0};
    start_tasks(of, 2, [&](std::uint32_t i) {
      for (std::uint32_t k = 0; i == 0 && k < ExhaustiveStrategy::steps_max + 10; ++k) word.store(k);
    });
    of.run();
  });
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.counts.cut_off, report.counts.executions);
}

TEST_F(ProverTest, says_what_was_covered_and_no_more) {
  ProveReport report;
  report.counts.executions = 18'432;
  report.complete = true;
  ProveOptions options;
  options.bounds = {.preemptions = 2, .silences = 1};
  options.memory = Memory::c11;
  EXPECT_EQ(describe_coverage(report, options),
            "all 18432 executions with at most 2 preemptions and 1 silence, memory c11; 0 cut off");
  report.counts.held_back = 7;
  EXPECT_EQ(describe_coverage(report, options),
            "all 18432 executions with at most 2 preemptions and 1 silence, memory c11; 0 cut off; in 7 of "
            "them a task that polled "
            "waited for a change after 4 looks");
  report.counts.held_back = 0;
  report.states = 300;
  options.bounds = {.preemptions = {}, .silences = std::nullopt, .states = true};
  options.memory = Memory::sc;
  EXPECT_EQ(describe_coverage(report, options),
            "all 300 states in 18432 executions with any number of preemptions and any number of silences, "
            "memory sc; 0 cut off");
  report.complete = false;
  report.counts.executions = 1;
  options = {};
  EXPECT_EQ(describe_coverage(report, options),
            "1 execution with any number of preemptions and no silence, one of each order that makes a "
            "difference, memory "
            "sc; 0 cut off");
}

}  // namespace
}  // namespace ltsim
