// The hardened handoff in a world: time-outs to the nanosecond, and every row of the kill table.
//
// Steps of the state word, as the schedules below count them: the emulator's first is its attach, then it takes, then it
// answers; the kernel's first is its attach, then it publishes, then it frees the areas.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "protocol/hardened/master.hpp"
#include "protocol/hardened/message.hpp"
#include "protocol/hardened/slave.hpp"
#include "tests/sim_clock/faults_fixture.hpp"

namespace protocol::hardened {
namespace {

using namespace std::chrono_literals;
using ltsim::World;
using std::chrono::nanoseconds;
using testing::AllOf;
using testing::ElementsAre;
using testing::Ge;
using testing::IsEmpty;
using testing::Lt;

constexpr const char* segment = "handoff";

std::vector<std::byte> bytes(std::string_view text) {
  const auto view = std::as_bytes(std::span(text));
  return {view.begin(), view.end()};
}
std::string text(std::span<const std::byte> view) {
  return {reinterpret_cast<const char*>(view.data()), view.size()};
}
std::string_view name_of(SharedMemoryError why) {
  switch (why) {
    case SharedMemoryError::unanswered:
      return ", unanswered";
    case SharedMemoryError::slave_gone:
      return ", slave gone";
    case SharedMemoryError::damaged:
      return ", damaged";
    default:
      return ", for no reason that there is";
  }
}

std::string_view name_of(ExchangeOutcome outcome) {
  constexpr std::array<std::string_view, 4> names{"ok", "rejected", "not executed", "unknown"};
  return names.at(static_cast<std::size_t>(outcome));
}

/// What an execution is made of. Its body is a plain function, so this is a variable; each test begins with a new one.
struct Plan {
  Options options;
  nanoseconds execution_time{0};
  nanoseconds emulator_sleeps_first{0};  // between opening and serving
  nanoseconds emulator_sleeps_after{0};  // each answer
  ExchangeObserver* listens_to_master = nullptr;
  std::string_view killed = {};
  std::vector<std::string> asked{"A"};
};
Plan plan;

/// What came of it; each execution begins with a new one.
struct Play {
  std::vector<std::string> executed;
  std::vector<std::string> outcomes;
  std::vector<nanoseconds> durations;
  unsigned slaves_count = 0;
};
Play play;

void run_emulator() {
  Slave slave{segment, plan.options};
  if (!slave.open()) return;
  ++play.slaves_count;
  std::this_thread::sleep_for(plan.emulator_sleeps_first);
  while (slave.wait_for_request()) {
    const std::string request = text(slave.read_request());
    if (request == "stop") slave.request_stop();
    play.executed.push_back(request);
    std::this_thread::sleep_for(plan.execution_time);
    slave.write_response(bytes("to " + request));
    std::this_thread::sleep_for(plan.emulator_sleeps_after);
  }
}

void ask(Master& master, const std::string& request) {
  std::array<std::byte, 16> answer{};
  const auto begin = std::chrono::steady_clock::now();
  const CallResult result = master.call(bytes(request), answer);
  play.durations.push_back(std::chrono::steady_clock::now() - begin);
  std::string outcome{name_of(result.outcome)};
  if (result.outcome == ExchangeOutcome::ok)
    outcome += ": " + text(std::span(answer).first(result.response_bytes));
  if (result.outcome == ExchangeOutcome::unknown) outcome += name_of(result.why);
  play.outcomes.push_back(outcome);
}

/// Asks, and then stops the emulator with a request that has time to spare. In its second life the kernel asks for "B".
void run_kernel(unsigned life) {
  while (play.slaves_count == 0) std::this_thread::sleep_for(1ms);
  Master master{segment, plan.options, plan.listens_to_master};
  if (!master.open()) return;
  std::this_thread::sleep_for(20ms);
  const std::vector<std::string> asked = life == 1 ? plan.asked : std::vector<std::string>{"B"};
  for (const std::string& request : asked) ask(master, request);
  master.set_timeouts(1h, 1h);
  std::this_thread::sleep_for(1s);
  std::array<std::byte, 16> answer{};
  static_cast<void>(master.call(bytes("stop"), answer));
}

void run_play(World& world) {
  play = {};
  plan.options.request_bytes_max = 16;
  plan.options.response_bytes_max = 16;
  world.name_region(segment, 0, 4, "segment.state");
  world.name_region(segment, 4, 4, "segment.request-length");
  world.name_region(segment, 8, header_bytes + 16, "segment.request");
  world.name_region(segment, 8 + header_bytes + 16, 4, "segment.response-length");
  world.name_region(segment, 12 + header_bytes + 16, header_bytes + 16, "segment.response");
  ltsim::Process& kernel = world.process("kernel");
  kernel.start("main", [&kernel] { run_kernel(kernel.incarnation()); });
  world.process("emulator").start("main", &run_emulator);
  if (!plan.killed.empty()) world.process(plan.killed).may_crash({.times = 1, .restart_after = 5ms});
  world.run();
  EXPECT_EQ(play.executed.back(), "stop");
  play.executed.pop_back();
}

class HardenedWorld : public ltsim::FaultsTest {
 protected:
  HardenedWorld() { plan = {}; }

  static void run_undisturbed() { EXPECT_EQ(run_with({}, &run_play), ltsim::Outcome{}); }
  static void run_killing(std::string_view killed, const std::string& line) {
    plan.killed = killed;
    EXPECT_EQ(run_with({"crash " + line + " of " + std::string{killed}}, &run_play), ltsim::Outcome{});
  }
};

// --- time-outs ---

class HardenedTimeOut : public HardenedWorld, public testing::WithParamInterface<Options::Doorbells> {
 protected:
  HardenedTimeOut() { plan.options.doorbells = GetParam(); }

  /// What steps and looks may take.
  static constexpr nanoseconds slack = 10us;
};

TEST_P(HardenedTimeOut, withdraws_what_nobody_takes_at_its_time_out_and_not_before) {  // I15, I16
  plan.options.take_timeout = 30ms;
  plan.emulator_sleeps_first = 200ms;
  run_undisturbed();
  EXPECT_THAT(play.outcomes, ElementsAre("not executed"));
  EXPECT_THAT(play.durations, ElementsAre(AllOf(Ge(30ms), Lt(30ms + slack))));
  EXPECT_THAT(play.executed, IsEmpty());
}

TEST_P(HardenedTimeOut, gives_up_what_is_not_answered_after_both_time_outs_and_not_before) {
  plan.options.take_timeout = 30ms;
  plan.options.answer_timeout = 50ms;
  plan.options.queries_max = 0;
  plan.execution_time = 200ms;
  run_undisturbed();
  EXPECT_THAT(play.outcomes, ElementsAre("unknown, unanswered"));
  EXPECT_THAT(play.durations, ElementsAre(AllOf(Ge(80ms), Lt(80ms + slack))));
  EXPECT_THAT(play.executed, ElementsAre("A"));
}

TEST_P(HardenedTimeOut, takes_no_longer_than_the_answer) {
  plan.options.poll_interval = 1ms;
  plan.execution_time = 7ms;
  run_undisturbed();
  EXPECT_THAT(play.outcomes, ElementsAre("ok: to A"));
  const nanoseconds poll = GetParam() == Options::Doorbells::one ? 1ms : 0ms;
  EXPECT_THAT(play.durations, ElementsAre(AllOf(Ge(7ms), Lt(7ms + poll + slack))));
}

TEST_P(HardenedTimeOut, leaves_a_query_that_gets_the_late_answer_and_executes_nothing_again) {
  plan.options.take_timeout = 30ms;
  plan.options.answer_timeout = 50ms;
  plan.execution_time = 100ms;
  run_undisturbed();
  EXPECT_THAT(play.outcomes, ElementsAre("ok: to A"));
  EXPECT_THAT(play.executed, ElementsAre("A"));
}

TEST_P(HardenedTimeOut, bounds_a_query_as_well) {
  plan.options.take_timeout = 30ms;
  plan.options.answer_timeout = 50ms;
  plan.execution_time = 10s;
  run_undisturbed();
  EXPECT_THAT(play.outcomes, ElementsAre("unknown, unanswered"));
  // The query waits for the slave to come back, and is not published.
  EXPECT_THAT(play.durations, ElementsAre(AllOf(Ge(110ms), Lt(110ms + slack))));
}

TEST_P(HardenedTimeOut, of_a_query_leaves_the_outcome_unknown) {
  plan.options.take_timeout = 30ms;
  plan.options.answer_timeout = 50ms;
  plan.execution_time = 100ms;
  plan.emulator_sleeps_after = 1min;
  run_undisturbed();
  EXPECT_THAT(play.outcomes, ElementsAre("unknown, unanswered"));
  // The query is published at 100 ms and withdrawn at 110 ms; the request was executed.
  EXPECT_THAT(play.durations, ElementsAre(AllOf(Ge(110ms), Lt(110ms + slack))));
  EXPECT_THAT(play.executed, ElementsAre("A"));
}

TEST_P(HardenedTimeOut, of_a_query_leaves_room_for_another) {
  plan.options.take_timeout = 30ms;
  plan.options.answer_timeout = 50ms;
  plan.options.queries_max = 2;
  plan.execution_time = 100ms;
  plan.emulator_sleeps_after = 15ms;
  run_undisturbed();
  EXPECT_THAT(play.outcomes, ElementsAre("ok: to A"));
  EXPECT_THAT(play.durations, ElementsAre(AllOf(Ge(115ms), Lt(117ms))));
  EXPECT_THAT(play.executed, ElementsAre("A"));
}

/// Writes into the request area after the second publication, as nobody should.
class DamagesTheQuery final : public ExchangeObserver {
 public:
  void published() noexcept override {
    if (++published_count_ != 2) return;
    NamedMemory memory;
    const std::size_t size_bytes = segment_layout(header_bytes + plan.options.request_bytes_max,
                                                  header_bytes + plan.options.response_bytes_max)
                                       .size_bytes;
    ASSERT_FALSE(memory.open(segment, size_bytes));
    static_cast<std::byte*>(memory.region.get_address())[8 + header_bytes] = std::byte{'B'};
  }
  void submitted(std::span<const std::byte> /*request*/) noexcept override { published_count_ = 0; }

 private:
  unsigned published_count_ = 0;
};

TEST_P(HardenedTimeOut, leaves_a_query_whose_rejection_says_nothing_of_the_request) {
  DamagesTheQuery damages;
  plan.options.take_timeout = 30ms;
  plan.options.answer_timeout = 50ms;
  plan.execution_time = 100ms;
  plan.listens_to_master = &damages;
  EXPECT_EQ(run_with(
                {},
                +[](World& world) {
                  world.allow_data_races();
                  run_play(world);
                }),
            ltsim::Outcome{});
  EXPECT_THAT(play.outcomes, ElementsAre("unknown, damaged"));
  EXPECT_THAT(play.executed, ElementsAre("A"));
}

TEST_P(HardenedTimeOut, makes_the_next_request_wait_until_the_slave_has_dropped_the_last_one) {
  plan.options.queries_max = 0;
  plan.options.answer_timeout = 0ms;
  plan.execution_time = 150ms;
  plan.asked = {"A", "B"};
  run_undisturbed();
  // B is published at 150 ms, taken at once, and given up at 200 ms.
  EXPECT_THAT(play.outcomes, ElementsAre("unknown, unanswered", "unknown, unanswered"));
  EXPECT_THAT(play.durations,
              ElementsAre(AllOf(Ge(100ms), Lt(100ms + slack)), AllOf(Ge(100ms), Lt(100ms + slack))));
  EXPECT_THAT(play.executed, ElementsAre("A", "B"));
}

TEST_P(HardenedTimeOut, is_not_moved_by_a_wall_clock_that_is_set) {  // I15, I16
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    play = {};
    plan = {};
    plan.options.doorbells = GetParam();
    plan.options.take_timeout = 30ms;
    plan.emulator_sleeps_first = 2min;
    ltsim::RandomStrategy strategy;
    const ltsim::Outcome outcome = run_under(strategy, seed, [](World& world) {
      world.grant(ltsim::FaultKind::clock_step, 3);
      world.process("operator").start("main", [] {
        // Where the wall clock is looked at, it may be set.
        for (int i = 0; i < 10; ++i) {
          static_cast<void>(std::chrono::system_clock::now());
          std::this_thread::sleep_for(5ms);
        }
      });
      world.process("kernel").start("main", [] { run_kernel(1); });
      world.process("emulator").start("main", &run_emulator);
    });
    EXPECT_EQ(outcome, ltsim::Outcome{}) << seed;
    ASSERT_THAT(play.durations, ElementsAre(Ge(30ms))) << seed;
    ASSERT_THAT(play.durations, ElementsAre(Lt(1min))) << seed;
    ASSERT_THAT(play.outcomes, ElementsAre("not executed")) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Doorbells, HardenedTimeOut,
                         testing::Values(Options::Doorbells::two, Options::Doorbells::one),
                         [](const auto& tested) {
                           return tested.param == Options::Doorbells::two ? "two" : "one";
                         });

// --- the named objects ---

class HardenedObjects : public HardenedWorld {};

TEST_F(HardenedObjects, are_the_same_for_both_sides_whoever_removes_them_meanwhile) {  // I29
  for (std::uint64_t seed = 1; seed <= 3'000; ++seed) {
    play = {};
    ltsim::RandomStrategy strategy;
    const ltsim::Outcome outcome = run_under(strategy, seed, [](World& world) {
      plan.options.open_timeout = plan.options.take_timeout = plan.options.answer_timeout = 1h;
      world.process("operator").start("main", [] {
        for (int i = 0; i < 3; ++i) static_cast<void>(remove_segment(segment, plan.options));
      });
      // The operator plays both roles for a moment.
      world.process("kernel").start("main", [] {
        Master master{segment, plan.options};
        while (!master.open()) std::this_thread::sleep_for(1ms);
        for (std::array<std::byte, 16> answer{};
             master.call(bytes("A"), answer).outcome != ExchangeOutcome::ok;)
          std::this_thread::sleep_for(1ms);
      });
      world.process("emulator").start("main", [] {
        Slave slave{segment, plan.options};
        while (!slave.open()) std::this_thread::sleep_for(1ms);
        if (!slave.wait_for_request()) return;
        slave.write_response(slave.read_request());
      });
    });
    ASSERT_EQ(outcome, ltsim::Outcome{}) << seed;
  }
}

// --- the kill table: the emulator ---

class KilledEmulator : public HardenedWorld {};

TEST_F(KilledEmulator, in_its_wait_leaves_the_next_request_to_the_next_one) {
  run_killing("emulator", "kernel/main before sleep - #1");
  EXPECT_THAT(play.outcomes, ElementsAre("ok: to A"));
  EXPECT_THAT(play.executed, ElementsAre("A"));
}

TEST_F(KilledEmulator, before_the_take_has_not_executed_the_request_and_nobody_will) {
  run_killing("emulator", "emulator/main before atomic_update segment.state #2");
  EXPECT_THAT(play.outcomes, ElementsAre("not executed"));
  EXPECT_THAT(play.executed, IsEmpty());
}

TEST_F(KilledEmulator, before_it_executes_leaves_the_outcome_unknown) {
  run_killing("emulator", "emulator/main before atomic_load segment.request-length #1");
  EXPECT_THAT(play.outcomes, ElementsAre("unknown, slave gone"));
  EXPECT_THAT(play.executed, IsEmpty());
}

TEST_F(KilledEmulator, after_it_executed_leaves_the_outcome_unknown) {
  run_killing("emulator", "emulator/main before atomic_update segment.state #3");
  EXPECT_THAT(play.outcomes, ElementsAre("unknown, slave gone"));
  EXPECT_THAT(play.executed, ElementsAre("A"));
}

TEST_F(KilledEmulator, with_a_request_that_was_given_up_leaves_its_outcome_unknown) {
  plan.options.take_timeout = 20ms;
  plan.options.answer_timeout = 10ms;
  plan.execution_time = 35ms;
  // The kernel's query waits for the slave from 30 ms to 50 ms; at 40 ms the next emulator is there, in another generation.
  run_killing("emulator", "emulator/main before write segment.response #1");
  EXPECT_THAT(play.outcomes, ElementsAre("unknown, slave gone"));
  EXPECT_THAT(play.executed, ElementsAre("A"));
}

TEST_F(KilledEmulator, with_a_query_that_it_has_not_taken_leaves_the_outcome_unknown) {
  plan.options.take_timeout = 30ms;
  plan.options.answer_timeout = 50ms;
  plan.execution_time = 100ms;
  plan.emulator_sleeps_after = 1min;
  // The first ring was for the request. By the next emulator the query is dropped, which says nothing of the request.
  run_killing("emulator", "kernel/main before sem_post handoff.request #2");
  EXPECT_THAT(play.outcomes, ElementsAre("unknown, slave gone"));
  EXPECT_THAT(play.executed, ElementsAre("A"));
}

TEST_F(KilledEmulator, after_its_answer_has_answered) {
  run_killing("emulator", "emulator/main before sem_post handoff.response #2");
  EXPECT_THAT(play.outcomes, ElementsAre("ok: to A"));
  EXPECT_THAT(play.executed, ElementsAre("A"));
}

// --- the kill table: the kernel ---

class KilledKernel : public HardenedWorld {};

TEST_F(KilledKernel, filling_the_area_leaves_nothing) {
  run_killing("kernel", "kernel/main before write segment.request #2");
  EXPECT_THAT(play.outcomes, ElementsAre("ok: to B"));
  EXPECT_THAT(play.executed, ElementsAre("B"));
}

TEST_F(KilledKernel, before_its_ring_leaves_a_request_that_is_never_executed) {
  run_killing("kernel", "kernel/main before sem_post handoff.request #1");
  EXPECT_THAT(play.outcomes, ElementsAre("ok: to B"));
  EXPECT_THAT(play.executed, ElementsAre("B"));
}

TEST_F(KilledKernel, waiting_leaves_a_request_that_is_executed_once_and_its_answer_dropped) {
  plan.execution_time = 10ms;
  run_killing("kernel", "emulator/main before atomic_load segment.request-length #1");
  EXPECT_THAT(play.outcomes, ElementsAre("ok: to B"));
  EXPECT_THAT(play.executed, ElementsAre("A", "B"));
}

TEST_F(KilledKernel, copying_the_answer_leaves_it_to_nobody) {
  run_killing("kernel", "kernel/main before read segment.response #2");
  EXPECT_THAT(play.outcomes, ElementsAre("ok: to B"));
  EXPECT_THAT(play.executed, ElementsAre("A", "B"));
}

TEST_F(KilledKernel, that_made_the_segment_and_did_not_finish_is_in_nobodys_way) {
  for (unsigned step = 1; step <= 2; ++step) {  // the roles, the segment
    run_killing("kernel", "kernel/main before shm_map - #" + std::to_string(step));
    EXPECT_THAT(play.outcomes, ElementsAre("ok: to B")) << step;
  }
}

}  // namespace
}  // namespace protocol::hardened
