// Choices that come from bytes: which record makes which decision, and that what they choose is written down and replayed like
// any other choice.

#include "sim_clock/explore/bytes_strategy.hpp"

#include <semaphore.h>

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include "sim_clock/explore/record_mutator.hpp"
#include "tests/sim_clock/faults_fixture.hpp"

namespace ltsim {
namespace {

using Kind = BytesStrategy::Kind;
using Record = BytesStrategy::Record;
using Bytes = std::vector<std::byte>;

Bytes bytes_of(const std::vector<Record>& records) {
  Bytes bytes;
  for (const Record& record : records) {
    std::array<std::byte, BytesStrategy::record_bytes> one;
    BytesStrategy::write(record, one);
    bytes.insert(bytes.end(), one.begin(), one.end());
  }
  return bytes;
}

Record record_of(Kind kind, std::uint16_t skipped, std::uint16_t value) {
  return {.kind = static_cast<std::uint8_t>(kind), .skipped_count = skipped, .value = value};
}

Record record_of(FaultKind kind, std::uint16_t skipped, std::uint16_t value) {
  return {.kind = BytesStrategy::kind_of(kind), .skipped_count = skipped, .value = value};
}

/// One after the other, as an execution would ask.
class BytesStrategyTest : public FaultsTest {
 protected:
  void begin(Bytes bytes) {
    bytes_ = std::move(bytes);
    strategy_.set_bytes(bytes_);
    strategy_.begin_execution(0);
  }
  std::size_t task() {
    static constexpr std::array<std::uint64_t, 3> options{4, 5, 6};
    return strategy_.choose_task({.options = options, .pending = {}, .under_way = {}});
  }
  SlowMoment slow_moment(bool can_be_held_up = true) {
    return strategy_.slow_moment({.until_next_timer = 7ms,
                                  .running_can_be_held_up = can_be_held_up,
                                  .runnable = {},
                                  .pending = {},
                                  .under_way = {}});
  }
  std::vector<std::size_t> answers(std::size_t asked, std::size_t count) {
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < asked; ++i) all.push_back(strategy_.answer(count));
    return all;
  }

  BytesStrategy strategy_;

 private:
  Bytes bytes_;
};

TEST_F(BytesStrategyTest, no_bytes_are_the_default) {
  begin({});
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(task(), 0U);
    EXPECT_EQ(slow_moment().duration, SimTime{0});
    EXPECT_EQ(strategy_.strike(FaultKind::lost_post, 3), 0U);
    EXPECT_EQ(strategy_.answer(2), 0U);
  }
}

TEST_F(BytesStrategyTest, a_record_skips_decisions_of_its_kind_and_answers_one_not_by_the_default) {
  begin(bytes_of(
      {record_of(Kind::answer, 2, 0), record_of(Kind::answer, 0, 3), record_of(Kind::answer, 1, 8)}));
  EXPECT_EQ(answers(7, 5), (std::vector<std::size_t>{0, 0, 1, 4, 0, 1, 0}));
}

TEST_F(BytesStrategyTest, each_kind_counts_its_own_decisions_only) {
  const Record answer = record_of(Kind::answer, 1, 1);
  begin(bytes_of({record_of(Kind::task, 1, 1), answer, record_of(FaultKind::crash, 0, 1)}));
  EXPECT_EQ(strategy_.strike(FaultKind::lost_post, 2), 0U);
  EXPECT_EQ(answers(2, 4), (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(task(), 0U);
  EXPECT_EQ(task(), 2U);
  EXPECT_EQ(strategy_.strike(FaultKind::crash, 2), 2U);
  // One that is put in before it, of another kind, moves nothing.
  begin(bytes_of({record_of(Kind::task, 0, 0), answer}));
  EXPECT_EQ(answers(2, 4), (std::vector<std::size_t>{0, 2}));
}

TEST_F(BytesStrategyTest, every_kind_of_fault_strikes_in_every_way) {
  for (std::size_t i = 0; i < fault_kinds_count; ++i) {
    const auto kind = static_cast<FaultKind>(i);
    begin(bytes_of({record_of(kind, 0, 0), record_of(kind, 0, 1), record_of(kind, 0, 5)}));
    EXPECT_EQ(strategy_.strike(kind, 3), 1U) << to_string(kind);
    EXPECT_EQ(strategy_.strike(kind, 3), 2U) << to_string(kind);
    EXPECT_EQ(strategy_.strike(kind, 3), 3U) << to_string(kind);
    EXPECT_EQ(strategy_.strike(kind, 3), 0U) << to_string(kind);
  }
}

TEST_F(BytesStrategyTest, the_machine_or_one_task_is_slow_until_the_next_timer_or_for_one_of_the_durations) {
  begin(bytes_of({record_of(Kind::slow_machine, 0, 0), record_of(Kind::slow_task, 1, 2)}));
  SlowMoment moment = slow_moment();
  EXPECT_EQ(moment.duration, 7ms);
  EXPECT_FALSE(moment.others_go_on);
  EXPECT_EQ(slow_moment().duration, SimTime{0});
  EXPECT_EQ(slow_moment(false).duration, SimTime{0}) << "a task that is not about to take a step";
  moment = slow_moment();
  EXPECT_EQ(moment.duration, BytesStrategy::durations[1]);
  EXPECT_TRUE(moment.others_go_on);
}

TEST_F(BytesStrategyTest, what_is_no_kind_counts_as_one) {
  Record record = record_of(Kind::answer, 0, 2);
  record.kind += 3 * BytesStrategy::kinds_count;
  begin(bytes_of({record}));
  EXPECT_EQ(answers(2, 4), (std::vector<std::size_t>{3, 0}));
}

TEST_F(BytesStrategyTest, a_record_cut_short_goes_on_with_zeros) {
  begin({static_cast<std::byte>(Kind::answer), std::byte{1}});
  EXPECT_EQ(answers(3, 4), (std::vector<std::size_t>{0, 1, 0}));
}

TEST_F(BytesStrategyTest, records_are_cut_as_they_are_read) {
  const std::string text(12, 'x');
  const auto records = BytesStrategy::split(text);
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(records[1].data(), text.data() + 5);
  EXPECT_EQ(records[2].size(), 2U);
}

TEST_F(BytesStrategyTest, tells_how_many_decisions_there_were_of_each_kind) {
  begin({});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(task(), 0U);
  begin({});
  EXPECT_EQ(task(), 0U);
  begin({});
  EXPECT_EQ(strategy_.most_decisions()[static_cast<std::size_t>(Kind::task)], 3U);
  EXPECT_EQ(strategy_.most_decisions()[static_cast<std::size_t>(Kind::answer)], 0U);
}

void two_sides(World& world) {
  for (const FaultKind kind : {FaultKind::lost_post, FaultKind::doubled_post, FaultKind::interrupt})
    world.grant(kind, 2);
  world.process("one").may_crash({.times = 1, .restart_after = 1ms});
  world.process("two").may_stall(1);
  const auto word = std::make_shared<std::atomic<unsigned>>(0);
  world.process("one").start("main", [word, &world] {
    for (unsigned i = 0; i < 4; ++i) {
      word->fetch_add(static_cast<unsigned>(world.choose("step", 3)));
      sem_post(open_semaphore());
      std::this_thread::sleep_for(1ms);
    }
  });
  world.process("two").start("main", [word] {
    for (int i = 0; i < 4; ++i) {
      timespec deadline{.tv_sec = time(nullptr) + 1, .tv_nsec = 0};
      sem_timedwait(open_semaphore(), &deadline);
      *word = *word + 1;
    }
  });
  world.run();
}

TEST_F(BytesStrategyTest, an_empty_string_is_the_default_schedule) {
  const Scenario scenario{"test/faults", "", &two_sides};
  BytesStrategy bytes;
  DefaultStrategy by_default;
  Explorer explorer{world()};
  EXPECT_EQ(explorer.execute(scenario, bytes, 1, nullptr),
            explorer.execute(scenario, by_default, 2, nullptr));
}

TEST_F(BytesStrategyTest,
       the_same_bytes_are_the_same_execution_and_so_is_the_schedule_that_they_are_written_down_as) {
  const Scenario scenario{"test/faults", "", &two_sides};
  BytesStrategy strategy;
  Explorer explorer{world()};
  RandomGenerator random{1};
  std::map<Deviation::Kind, unsigned> seen;
  for (unsigned round = 0; round < 300; ++round) {
    Bytes bytes(random.below(16) * BytesStrategy::record_bytes);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.below(8));
    strategy.set_bytes(bytes);
    const SignalGuard signals;
    const std::uint64_t hash = explorer.execute(scenario, strategy, 0, nullptr);
    const Failure recorded = explorer.record(scenario, strategy, 0);
    ASSERT_EQ(recorded.trace_hash, hash) << round;
    for (const Deviation& line : recorded.schedule.deviations) ++seen[line.kind];
    const auto schedule = parse_schedule(to_string(recorded.schedule));
    ASSERT_TRUE(schedule) << schedule.error().reason;
    const ReplayReport replayed = replay(*schedule, &two_sides);
    ASSERT_EQ(replayed.trace_hash, hash) << to_string(recorded.schedule);
    ASSERT_FALSE(replayed.divergence) << replayed.divergence->reason;
  }
  EXPECT_EQ(seen.size(), 5U) << "of the kinds of lines";
}

TEST_F(BytesStrategyTest, a_program_that_polls_for_ever_ends_as_a_livelock) {
  const auto polls = [](World& it) {
    it.set_points_max(10'000);
    const auto word = std::make_shared<std::atomic<int>>(0);
    it.process("p").start("main", [word] {
      while (*word == 0) std::this_thread::yield();
    });
    it.process("q").start("main", [word] {
      while (*word == 0) std::this_thread::yield();
    });
    it.run();
  };
  begin(bytes_of(std::vector<Record>(1000, record_of(Kind::task, 0, 0))));
  EXPECT_EQ(run_under(strategy_, 0, polls).kind, OutcomeKind::livelock);
}

TEST(RecordMutator, makes_whole_records_of_kinds_that_are_asked_for_and_is_the_same_for_a_seed) {
  BytesStrategy::DecisionCounts decisions{};
  decisions[static_cast<std::size_t>(Kind::answer)] = 40;
  decisions[BytesStrategy::kind_of(FaultKind::interrupt)] = 2;
  constexpr std::size_t room = 10 * BytesStrategy::record_bytes + 3;
  std::array<std::byte, room> bytes{};
  std::size_t size = 0;
  std::map<std::size_t, unsigned> sizes;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    auto again = bytes;
    const std::size_t changed = RecordMutator{decisions, seed}.mutate(bytes, size);
    ASSERT_EQ((RecordMutator{decisions, seed}.mutate(again, size)), changed);
    ASSERT_TRUE(std::ranges::equal(std::span{bytes}.first(changed), std::span{again}.first(changed)));
    size = changed;
    ++sizes[size / BytesStrategy::record_bytes];
    ASSERT_EQ(size % BytesStrategy::record_bytes, 0U);
    ASSERT_LE(size, room);
    for (std::size_t at = 0; at < size; at += BytesStrategy::record_bytes) {
      const Record record = BytesStrategy::read(std::span{bytes}.subspan(at));
      ASSERT_NE(decisions[record.kind], 0U) << seed;
    }
  }
  EXPECT_EQ(sizes.size(), 10U) << "from one record to as many as there is room for";
}

TEST(RecordMutator, splices_the_first_records_of_one_with_the_last_of_the_other) {
  const BytesStrategy::DecisionCounts decisions{};
  const Bytes one = bytes_of({record_of(Kind::task, 1, 0), record_of(Kind::task, 2, 0)});
  const Bytes other = bytes_of({record_of(Kind::task, 3, 0), record_of(Kind::task, 4, 0)});
  std::map<std::vector<std::uint16_t>, unsigned> seen;
  for (unsigned seed = 0; seed < 500; ++seed) {
    Bytes into(3 * BytesStrategy::record_bytes);
    into.resize(RecordMutator{decisions, seed}.splice(one, other, into));
    std::vector<std::uint16_t> skips;
    for (std::size_t at = 0; at < into.size(); at += BytesStrategy::record_bytes)
      skips.push_back(BytesStrategy::read(std::span{into}.subspan(at)).skipped_count);
    ++seen[skips];
  }
  const std::map<std::vector<std::uint16_t>, unsigned> all{
      {{}, 0}, {{4}, 0}, {{3, 4}, 0}, {{1}, 0}, {{1, 4}, 0}, {{1, 3, 4}, 0}, {{1, 2}, 0}, {{1, 2, 4}, 0}};
  ASSERT_EQ(seen.size(), all.size());
  for (const auto& [skips, count] : all) EXPECT_GT(seen[skips], 0U);
}

}  // namespace
}  // namespace ltsim
