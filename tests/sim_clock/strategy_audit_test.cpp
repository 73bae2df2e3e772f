// The decisions of every randomised strategy over a toy program, against the distribution that its header
// promises. The audit is worth something only if it can fail: each check is made a second time with seeds of two
// bits, and must then fail.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/swarm_strategy.hpp"

namespace ltsim {
namespace {

using SeedOf = std::uint64_t (*)(std::uint64_t);

std::uint64_t good_seed(std::uint64_t number) { return Explorer::seed_of(1, number); }
std::uint64_t weak_seed(std::uint64_t number) { return good_seed(number) & 3U; }

/// Tasks that each make a number of stores to one word: all of them conflict.
class ToyProgram {
 public:
  ToyProgram(std::size_t tasks_count, std::size_t steps_count) : steps_(tasks_count, steps_count) {
    pending_.fill({.kind = OperationKind::atomic_store, .bytes = 4, .object = 1});
  }

  /// @return which task made each step: "0110"
  std::string run(Strategy& strategy, std::uint64_t seed) {
    strategy.begin_execution(seed);
    std::vector<std::size_t> left = steps_;
    std::string steps;
    TaskId running = 0;
    for (;;) {
      std::vector<std::uint64_t> options;
      for (std::size_t task = 0; task < left.size(); ++task) {
        if (left[task] != 0) options.push_back(task);
      }
      if (options.empty()) return steps;
      std::size_t chosen = 0;
      if (options.size() > 1)
        chosen = strategy.choose_task(
            {.options = options, .running = running, .pending = pending_, .under_way = {}});
      running = static_cast<TaskId>(options.at(chosen));
      strategy.performs(running, pending_[running]);
      --left[running];
      steps += static_cast<char>('0' + running);
    }
  }

  /// What the strategy is to know of the program before it is judged.
  void teach(Strategy& strategy) {
    for (std::uint64_t i = 0; i < 50; ++i) {
      static_cast<void>(run(strategy, good_seed(1'000'000 + i)));
      strategy.learn({});
    }
  }

 private:
  std::vector<std::size_t> steps_;
  std::array<Operation, tasks_max> pending_{};
};

/// Whether the observed numbers could come from these expectations: chi-square at most five standard deviations
/// and ten above its mean, which a fair source exceeds once in millions.
bool fits(const std::vector<double>& observed, const std::vector<double>& expected) {
  double sum = 0;
  for (std::size_t i = 0; i < observed.size(); ++i)
    sum += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
  const auto degrees = static_cast<double>(observed.size() - 1);
  return sum <= degrees + 5 * std::sqrt(2 * degrees) + 10;
}

/// Whether each of `possible` interleavings comes as often as the others.
bool all_alike(Strategy& strategy, ToyProgram program, std::size_t possible, SeedOf seed_of) {
  constexpr std::uint64_t executions = 50'000;
  program.teach(strategy);
  std::map<std::string, double> counts;
  for (std::uint64_t i = 1; i <= executions; ++i) ++counts[program.run(strategy, seed_of(i))];
  std::vector<double> observed;
  for (const auto& [steps, count] : counts) observed.push_back(count);
  observed.resize(possible, 0);
  return fits(observed,
              std::vector<double>(possible, static_cast<double>(executions) / static_cast<double>(possible)));
}

/// How long one of two tasks runs in a row, and who follows whom, if each step is a fair coin's.
bool steps_are_fair_coins(Strategy& strategy, SeedOf seed_of) {
  constexpr std::size_t longest = 10;  // longer runs are counted together
  constexpr std::size_t steps_each = 500;
  constexpr std::uint64_t executions = 2'000;  // a million decisions, those near the end left out
  ToyProgram program{2, steps_each};
  program.teach(strategy);
  std::vector<double> runs(longest, 0);
  std::vector<double> pairs(4, 0);
  double runs_count = 0;
  double pairs_count = 0;
  for (std::uint64_t i = 1; i <= executions; ++i) {
    const std::string steps = program.run(strategy, seed_of(i)).substr(0, steps_each);
    std::size_t run = 1;
    for (std::size_t at = 1; at < steps.size(); ++at) {
      ++pairs[static_cast<std::size_t>(steps[at - 1] - '0') * 2 + static_cast<std::size_t>(steps[at] - '0')];
      ++pairs_count;
      if (steps[at] == steps[at - 1]) {
        ++run;
        continue;
      }
      ++runs[std::min(run, longest) - 1];
      ++runs_count;
      run = 1;
    }
  }
  std::vector<double> expected_runs(longest);
  for (std::size_t i = 0; i < longest; ++i)
    expected_runs[i] = runs_count * std::ldexp(1, -static_cast<int>(std::min(i + 1, longest - 1)));
  return fits(runs, expected_runs) && fits(pairs, std::vector<double>(4, pairs_count / 4));
}

struct Audited {
  const char* name;
  std::unique_ptr<Strategy> (*make)();
};

template <class Kind>
std::unique_ptr<Strategy> make() {
  return std::make_unique<Kind>();
}

class OrderAudit : public testing::TestWithParam<Audited> {};

TEST_P(OrderAudit, three_tasks_come_in_each_order_alike) {
  EXPECT_TRUE(all_alike(*GetParam().make(), ToyProgram{3, 1}, 6, &good_seed));
  EXPECT_FALSE(all_alike(*GetParam().make(), ToyProgram{3, 1}, 6, &weak_seed));
}

INSTANTIATE_TEST_SUITE_P(Strategies, OrderAudit,
                         testing::Values(Audited{"random", &make<RandomStrategy>},
                                         Audited{"pct", &make<PctStrategy>},
                                         Audited{"pos", &make<PosStrategy>},
                                         Audited{"surw", &make<SurwStrategy>}),
                         [](const auto& tested) { return tested.param.name; });

class CoinAudit : public testing::TestWithParam<Audited> {};

TEST_P(CoinAudit, conflicting_steps_of_two_tasks_are_fair_coins) {
  EXPECT_TRUE(steps_are_fair_coins(*GetParam().make(), &good_seed));
  EXPECT_FALSE(steps_are_fair_coins(*GetParam().make(), &weak_seed));
}

INSTANTIATE_TEST_SUITE_P(Strategies, CoinAudit,
                         testing::Values(Audited{"random", &make<RandomStrategy>},
                                         Audited{"pos", &make<PosStrategy>}),
                         [](const auto& tested) { return tested.param.name; });

TEST(SurwAudit, all_interleavings_of_the_interesting_operations_are_alike) {
  SurwStrategy strategy;
  EXPECT_TRUE(all_alike(strategy, ToyProgram{2, 3}, 20, &good_seed));
  SurwStrategy weak;
  EXPECT_FALSE(all_alike(weak, ToyProgram{2, 3}, 20, &weak_seed));
  // The random walk does not have that property: an order that ends with three of one task is more likely.
  RandomStrategy random;
  EXPECT_FALSE(all_alike(random, ToyProgram{2, 3}, 20, &good_seed));
}

/// After how many of its steps the first task falls, 0: never; as the header of PctStrategy says it: a change
/// point in two of three executions, a second in two of three of those ..., each anywhere in the whole program, or,
/// one in four, within the first 1, 2, 4 ... steps.
std::vector<double> falls_expected(std::size_t steps_each, double executions) {
  RandomGenerator generator{7};
  std::vector<double> falls(steps_each, 0);
  constexpr int samples = 2'000'000;
  const auto length = static_cast<std::uint32_t>(2 * steps_each);
  for (int i = 0; i < samples; ++i) {
    std::uint32_t first = length;
    for (int points = 0; points < 5 && generator.below(3) != 0; ++points) {
      const bool near = generator.below(4) == 0;
      const auto orders = static_cast<std::uint32_t>(std::bit_width(length));
      first = std::min(first, generator.below(near ? std::uint32_t{1} << generator.below(orders) : length));
    }
    ++falls[first + 1 < steps_each ? first + 1 : 0];
  }
  for (double& count : falls) count *= executions / samples;
  return falls;
}

bool falls_fit(SeedOf seed_of) {
  constexpr std::size_t steps_each = 20;
  constexpr std::uint64_t executions = 50'000;
  PctStrategy strategy;
  ToyProgram program{2, steps_each};
  program.teach(strategy);
  std::vector<double> falls(steps_each, 0);
  for (std::uint64_t i = 1; i <= executions; ++i) {
    const std::string steps = program.run(strategy, seed_of(i));
    const std::size_t run = std::min(steps.find_first_not_of(steps[0]), steps_each);
    ++falls[run < steps_each ? run : 0];
  }
  return fits(falls, falls_expected(steps_each, static_cast<double>(executions)));
}

TEST(PctAudit, priorities_change_anywhere_alike) {
  EXPECT_TRUE(falls_fit(&good_seed));
  EXPECT_FALSE(falls_fit(&weak_seed));
}

/// Orders of magnitude of the longest run in an execution, from 2^7 on: silences, for coins make none of that
/// length. As the header of StallStrategy says it.
std::vector<double> silences_expected(std::size_t first_order, std::size_t orders,
                                      std::uint32_t length_orders, double executions) {
  RandomGenerator generator{11};
  std::vector<double> counts(orders, 0);
  constexpr int samples = 1'000'000;
  for (int i = 0; i < samples; ++i) {
    std::size_t longest = 0;
    for (std::uint32_t silences = 1 + generator.below(3); silences != 0; --silences) {
      const bool counts_changes = generator.below(2) == 0;
      longest = std::max<std::size_t>(longest, generator.below(counts_changes ? 6 : length_orders));
    }
    if (longest >= first_order && longest < first_order + orders) ++counts[longest - first_order];
  }
  for (double& count : counts) count *= executions / samples;
  return counts;
}

/// Whether the longest silence of an execution is of each order of magnitude as often as expected.
bool silences_fit(SeedOf seed_of) {
  constexpr std::size_t steps_each = 8'192;
  constexpr std::uint64_t executions = 1'000;
  StallStrategy strategy;
  ToyProgram program{2, steps_each};
  for (std::uint64_t i = 0; i < 5; ++i) {
    static_cast<void>(program.run(strategy, good_seed(1'000'000 + i)));
    strategy.learn({});
  }
  constexpr std::size_t first_order = 6;
  constexpr std::size_t orders = 5;  // 64 to 2047 steps: longer ones do not always find room
  std::vector<double> counts(orders, 0);
  for (std::uint64_t i = 1; i <= executions; ++i) {
    const std::string steps = program.run(strategy, seed_of(i));
    std::size_t longest = 0;
    for (std::size_t at = 0; at < steps.size();) {
      const std::size_t end = std::min(steps.find_first_not_of(steps[at], at), steps.size());
      // A run up to the end of its task may have been cut short by that.
      if (steps.find(steps[at], end) != std::string::npos) longest = std::max(longest, end - at);
      at = end;
    }
    const std::size_t order = std::bit_width(longest) - std::size_t{1};
    if (order >= first_order && order < first_order + orders) ++counts[order - first_order];
  }
  // The estimate of the length lies between the choices of one execution and of the longest.
  const auto expected = silences_expected(first_order, orders, 14 + 3, static_cast<double>(executions));
  bool fit = true;
  for (std::size_t i = 0; i < orders; ++i)
    fit = fit && counts[i] > 0.6 * expected[i] && counts[i] < 1.6 * expected[i];
  return fit;
}

TEST(StallAudit, a_silence_is_as_often_of_one_order_of_magnitude_as_of_another) {
  EXPECT_TRUE(silences_fit(&good_seed));
  EXPECT_FALSE(silences_fit(&weak_seed));
}

/// Draws slow moments in bursts and counts them by order of magnitude: in microseconds, or, with a timer armed, in
/// multiples of the time to it.
std::vector<double> slow_moments(SimTime until_next_timer, std::size_t orders, SimTime unit, SeedOf seed_of) {
  RandomStrategy strategy;
  std::array<Operation, tasks_max> pending{};
  const std::array<std::uint64_t, 1> runnable{1};
  std::vector<double> counts(orders, 0);
  for (std::uint64_t execution = 1; execution <= 400; ++execution) {
    strategy.begin_execution(seed_of(execution));
    for (int i = 0; i < 10'000; ++i) {
      const SlowMoment moment = strategy.slow_moment(
          {.until_next_timer = until_next_timer, .runnable = runnable, .pending = pending, .under_way = {}});
      const bool is_multiple =
          until_next_timer == VirtualClock::never || moment.duration % unit == SimTime{0};
      if (moment.duration == SimTime{0} || !is_multiple) continue;
      const auto order = std::bit_width(static_cast<std::uint64_t>(moment.duration / unit)) - std::size_t{1};
      if (order < orders) ++counts[order];
    }
  }
  return counts;
}

bool alike(const std::vector<double>& counts) {
  double sum = 0;
  for (const double count : counts) sum += count;
  return sum > 10'000 &&
         fits(counts, std::vector<double>(counts.size(), sum / static_cast<double>(counts.size())));
}

TEST(SlowMomentAudit, each_order_of_magnitude_from_a_microsecond_to_a_second_is_alike) {
  constexpr SimTime microsecond{1000};
  EXPECT_TRUE(alike(slow_moments(VirtualClock::never, 21, microsecond, &good_seed)));
  EXPECT_FALSE(alike(slow_moments(VirtualClock::never, 21, microsecond, &weak_seed)));
}

TEST(SlowMomentAudit, each_order_of_magnitude_of_multiples_of_the_next_timer_is_alike) {
  constexpr SimTime prime{1'000'003};  // no time in microseconds is a multiple of it
  EXPECT_TRUE(alike(slow_moments(prime, 4, prime, &good_seed)));
  EXPECT_FALSE(alike(slow_moments(prime, 4, prime, &weak_seed)));
}

TEST(Swarm, gives_every_member_its_turn_also_when_one_yields_all) {
  // A program whose first task to step is the strategy's own affair: which member ran is told by its walk.
  SwarmStrategy strategy;
  std::map<bool, int> follows;
  for (std::uint64_t i = 1; i <= 2'000; ++i) {
    strategy.begin_execution(good_seed(i));
    ++follows[strategy.follows_steps()];  // random alone does not
    strategy.learn({.new_states = strategy.follows_steps() ? 10U : 0U});
  }
  EXPECT_GE(follows[false], 2'000 * 3 / 4 / 24);  // its share of the cycle
  EXPECT_GE(follows[true], 1'000);
}

}  // namespace
}  // namespace ltsim
