// Histories that are linearizable and histories that are not; the search against one that tries every order.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim_clock/check/history.hpp"
#include "sim_clock/explore/random_generator.hpp"
#include "tests/sim_clock/sequential_models.hpp"
#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

using Register = RegisterModel;
using Queue = QueueModel;

// --- a register ---

TEST(RegisterHistory, without_operations_is_linearizable) {
  EXPECT_EQ(History<Register>{}.check().verdict, Linearizability::linearizable);
}

TEST(RegisterHistory, of_overlapping_operations_may_take_effect_in_either_order) {
  for (const int seen : {0, 1}) {
    History<Register> history;
    const auto write = history.call(Register::write(1));
    const auto read = history.call(Register::read());
    history.returned(read, seen);
    history.returned(write, 1);
    EXPECT_EQ(history.check().verdict, Linearizability::linearizable) << seen;
  }
}

TEST(RegisterHistory, cannot_read_what_was_overwritten_before) {
  History<Register> history;
  history.returned(history.call(Register::write(1)), 1);
  history.returned(history.call(Register::write(2)), 2);
  history.returned(history.call(Register::read()), 1);
  EXPECT_EQ(history.check().verdict, Linearizability::not_linearizable);
}

// L. Lamport, "On interprocess communication" (1986): a regular register may do this, an atomic one may not.
TEST(RegisterHistory, cannot_show_the_new_value_and_then_the_old_one) {
  for (const bool new_value_first : {true, false}) {
    History<Register> history;
    const auto write = history.call(Register::write(1));
    history.returned(history.call(Register::read()), new_value_first ? 1 : 0);
    history.returned(history.call(Register::read()), new_value_first ? 0 : 1);
    history.returned(write, 1);
    EXPECT_EQ(history.check().verdict,
              new_value_first ? Linearizability::not_linearizable : Linearizability::linearizable);
  }
}

TEST(RegisterHistory, of_a_write_that_timed_out_may_show_it_late_or_never) {
  for (const std::vector<int>& seen : {std::vector{0, 0}, std::vector{0, 1}, std::vector{1, 1}}) {
    History<Register> history;
    history.timed_out(history.call(Register::write(1)));
    for (const int value : seen) history.returned(history.call(Register::read()), value);
    EXPECT_EQ(history.check().verdict, Linearizability::linearizable);
  }
}

TEST(RegisterHistory, of_a_write_that_timed_out_cannot_show_it_twice) {
  History<Register> history;
  history.timed_out(history.call(Register::write(1)));
  history.returned(history.call(Register::read()), 1);
  history.returned(history.call(Register::write(2)), 2);
  history.returned(history.call(Register::read()), 1);
  EXPECT_EQ(history.check().verdict, Linearizability::not_linearizable);
}

TEST(RegisterHistory, cannot_show_a_write_that_was_not_called_yet) {
  History<Register> history;
  history.returned(history.call(Register::read()), 1);
  history.timed_out(history.call(Register::write(1)));
  EXPECT_EQ(history.check().verdict, Linearizability::not_linearizable);
}

TEST(RegisterHistory, of_a_write_whose_result_nobody_saw_has_taken_effect_when_it_returned) {
  History<Register> history;
  history.returned_unseen(history.call(Register::write(1)));
  history.returned(history.call(Register::read()), 0);
  EXPECT_EQ(history.check().verdict, Linearizability::not_linearizable);
}

// --- a counter ---

TEST(CounterHistory, of_a_request_executed_twice_is_not_linearizable) {
  History<CounterModel> history;
  history.timed_out(history.call({.added = 1}));
  history.returned(history.call({.added = 10}), 12);
  EXPECT_EQ(history.check().verdict, Linearizability::not_linearizable);
}

TEST(CounterHistory, of_a_request_that_timed_out_counts_it_once_or_not_at_all) {
  for (const int sum : {10, 11}) {
    History<CounterModel> history;
    history.timed_out(history.call({.added = 1}));
    history.returned(history.call({.added = 10}), sum);
    EXPECT_EQ(history.check().verdict, Linearizability::linearizable) << sum;
  }
}

// --- a queue: histories H1 to H4 of M. Herlihy, J. Wing, "Linearizability" (1990) ---

TEST(QueueHistory, h1_of_overlapping_enqueues_may_be_dequeued_in_either_order) {
  History<Queue> history;
  const auto x = history.call(Queue::enqueue('x'), "A");
  const auto y = history.call(Queue::enqueue('y'), "B");
  history.returned(y, 0);
  history.returned(x, 0);
  const auto first = history.call(Queue::dequeue(), "B");
  history.returned(first, 'x');
  const auto second = history.call(Queue::dequeue(), "A");
  history.returned(second, 'y');
  history.call(Queue::enqueue('z'), "A");
  EXPECT_EQ(history.check().verdict, Linearizability::linearizable);
}

TEST(QueueHistory, h2_of_enqueues_in_turn_cannot_be_dequeued_in_the_other_order) {
  History<Queue> history;
  history.returned(history.call(Queue::enqueue('x'), "A"), 0);
  history.returned(history.call(Queue::enqueue('y'), "B"), 0);
  history.returned(history.call(Queue::dequeue(), "A"), 'y');
  EXPECT_EQ(history.check().verdict, Linearizability::not_linearizable);
}

TEST(QueueHistory, h3_may_dequeue_what_is_still_being_enqueued) {
  History<Queue> history;
  history.call(Queue::enqueue('x'), "A");
  history.returned(history.call(Queue::dequeue(), "B"), 'x');
  EXPECT_EQ(history.check().verdict, Linearizability::linearizable);
}

TEST(QueueHistory, h4_cannot_dequeue_the_same_item_twice) {
  History<Queue> history;
  const auto x = history.call(Queue::enqueue('x'), "A");
  const auto y = history.call(Queue::enqueue('y'), "B");
  history.returned(x, 0);
  history.returned(y, 0);
  const auto first = history.call(Queue::dequeue(), "A");
  const auto second = history.call(Queue::dequeue(), "C");
  history.returned(first, 'y');
  history.returned(second, 'y');
  EXPECT_EQ(history.check().verdict, Linearizability::not_linearizable);
}

// --- every order, tried ---

struct Recorded {
  Register::Operation operation;
  std::optional<int> result;
  OperationInterval interval;
};

/// Tries all orders of all operations that respect real time, remembering nothing.
bool some_order_explains(const std::vector<Recorded>& records, std::set<std::size_t> left, int state) {
  const auto must_come = [&](std::size_t i) {
    return records[i].interval.returned_at != OperationInterval::never;
  };
  if (std::none_of(left.begin(), left.end(), must_come)) return true;
  for (const std::size_t i : left) {
    const bool comes_too_late = std::any_of(left.begin(), left.end(), [&](std::size_t other) {
      return records[other].interval.returned_at < records[i].interval.called_at;
    });
    if (comes_too_late) continue;
    const Recorded& record = records[i];
    const int next = record.operation.writes ? record.operation.value : state;
    if (record.result && *record.result != next) continue;
    std::set<std::size_t> rest = left;
    rest.erase(i);
    if (some_order_explains(records, std::move(rest), next)) return true;
  }
  return false;
}

/// Up to six operations of three tasks on a register, with results out of the air; some never return.
std::vector<Recorded> random_records(RandomGenerator& random, History<Register>& history) {
  std::vector<Recorded> records;
  std::array<std::optional<std::size_t>, 3> running;  // by task
  std::uint32_t event = 0;
  while (event < 10) {
    auto& call = running[random.below(3)];
    if (!call) {
      if (records.size() == 6) break;
      const bool writes = random.below(2) == 0;
      const auto operation = writes ? Register::write(static_cast<int>(random.below(3))) : Register::read();
      call = history.call(operation);
      records.push_back({.operation = operation, .result = {}, .interval = {.called_at = event++}});
      continue;
    }
    Recorded& record = records[*call];
    if (random.below(6) == 0) {
      history.timed_out(*call);
    } else if (random.below(8) == 0) {
      history.returned_unseen(*call);
      record.interval.returned_at = event++;
    } else {
      record.result = record.operation.writes ? record.operation.value : static_cast<int>(random.below(3));
      history.returned(*call, *record.result);
      record.interval.returned_at = event++;
    }
    call.reset();
  }
  return records;
}

TEST(Linearizability, is_judged_as_by_trying_every_order) {
  RandomGenerator random{1};
  std::array<unsigned, 2> counts{};
  for (unsigned i = 0; i < 5000; ++i) {
    History<Register> history;
    const std::vector<Recorded> records = random_records(random, history);
    std::set<std::size_t> all;
    for (std::size_t index = 0; index < records.size(); ++index) all.insert(index);
    const bool expected = some_order_explains(records, all, 0);
    ASSERT_EQ(history.check().verdict == Linearizability::linearizable, expected)
        << i << history.check().message;
    ++counts[expected ? 1 : 0];
  }
  EXPECT_GT(counts[0], 1000U);
  EXPECT_GT(counts[1], 1000U);
}

// --- effort ---

/// All at once, and then a sum that no order gives.
History<CounterModel> overlapping_additions(unsigned count) {
  History<CounterModel> history;
  std::vector<std::size_t> calls;
  for (unsigned i = 0; i < count; ++i) calls.push_back(history.call({.added = 1}));
  for (const std::size_t call : calls) history.returned_unseen(call);
  history.returned(history.call({.added = 0}), -1);
  return history;
}

TEST(Linearizability, looks_at_a_set_of_operations_once_and_not_in_each_of_its_orders) {
  const HistoryReport report = overlapping_additions(12).check();  // 479,001,600 orders
  EXPECT_EQ(report.verdict, Linearizability::not_linearizable);
  EXPECT_LT(report.configurations, 1U << 12U);
}

TEST(Linearizability, is_not_decided_beyond_the_limit) {
  const HistoryReport report = overlapping_additions(12).check(100);
  EXPECT_EQ(report.verdict, Linearizability::not_decided);
  EXPECT_EQ(report.message,
            "history is not decided within 100 configurations: 13 operations overlap too much");
}

template <typename Model>
HistoryReport check_registers(bool last_is_wrong) {
  History<Model> history;
  std::vector<std::pair<std::size_t, int>> calls;
  for (int key = 0; key < 4; ++key) {
    for (int value = 1; value <= 3; ++value)
      calls.emplace_back(history.call(Model::write(value, key)), value);
  }
  for (const auto& [call, value] : calls) history.returned(call, value);
  history.returned(history.call(Model::read(3)), last_is_wrong ? 7 : 2);
  return history.check();
}

TEST(Linearizability, of_independent_parts_costs_the_sum_and_not_the_product) {
  EXPECT_EQ(check_registers<RegistersModel>(false).verdict, Linearizability::linearizable);
  const HistoryReport report = check_registers<RegistersModel>(true);
  EXPECT_EQ(report.verdict, Linearizability::not_linearizable);
  EXPECT_LT(report.configurations, 4 * 16U);
  EXPECT_GT(check_registers<RegisterModel>(true).configurations, 10'000U);
}

// --- what is told ---

TEST(HistoryMessage, shows_the_shortest_beginning_that_no_order_explains) {
  History<Register> history;
  history.returned(history.call(Register::write(1), "kernel/main"), 1);
  history.timed_out(history.call(Register::write(2), "kernel/main"));
  const auto late = history.call(Register::write(5), "emulator/panel");
  history.returned(history.call(Register::read(), "kernel/main"), 7);
  history.returned(history.call(Register::read(), "kernel/main"), 8);
  history.returned(late, 5);
  EXPECT_EQ(history.check().message,
            "history is not linearizable: no order of these operations gives the last result\n"
            "   1 to 2   kernel/main     write 1 = 1\n"
            "   3 to ?   kernel/main     write 2, timed out: may have taken effect\n"
            "   4 to ?   emulator/panel  write 5, not returned yet\n"
            "   5 to 6   kernel/main     read = 7");
}

TEST(HistoryMessage, fits_a_screen_however_long_the_history_is) {
  History<Register> history;
  for (int i = 0; i < 100; ++i) history.returned(history.call(Register::write(i), "p/main"), i);
  history.returned(history.call(Register::read(), "p/main"), 7);
  const std::string message = history.check().message;
  EXPECT_NE(message.find("(81 earlier operations)"), std::string::npos) << message;
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 21);
}

class HistoryInWorldTest : public WorldTest {
 protected:
  /// Two tasks add 1 to a shared counter, with a lock or without.
  static Outcome add_twice(bool with_lock) {
    return run_randomly(200, [with_lock](World& world) {
      struct Shared {
        std::atomic<int> sum = 0;
        std::mutex mutex;
        History<CounterModel> history;
      };
      Shared shared;
      for (const char* const task : {"one", "two"}) {
        world.process("p").start(task, [&shared, with_lock] {
          const auto call = shared.history.call({.added = 1});
          std::unique_lock lock{shared.mutex, std::defer_lock};
          if (with_lock) lock.lock();
          const int sum = shared.sum.load() + 1;
          shared.sum.store(sum);
          if (with_lock) lock.unlock();
          shared.history.returned(call, sum);
        });
      }
      world.run();
      shared.history.check_at_end(world);
    });
  }
};

TEST_F(HistoryInWorldTest, a_lost_addition_is_an_invariant_that_does_not_hold) {
  const Outcome outcome = add_twice(false);
  EXPECT_EQ(outcome.kind, OutcomeKind::invariant);
  EXPECT_NE(outcome.message.find("p/one  add 1 = 1"), std::string::npos) << outcome.message;
  EXPECT_NE(outcome.message.find("p/two  add 1 = 1"), std::string::npos) << outcome.message;
}

TEST_F(HistoryInWorldTest, additions_under_a_lock_are_linearizable) { EXPECT_EQ(add_twice(true), Outcome{}); }

TEST_F(HistoryInWorldTest, what_is_not_decided_is_our_limit_and_no_finding) {
  const Outcome outcome = run([](World& world) {
    world.run();
    overlapping_additions(12).check_at_end(world, 100);
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::unsupported);
}

}  // namespace
}  // namespace ltsim
