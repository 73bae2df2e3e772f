// Each function block against its defining equation over the whole history of its inputs, which a naive second
// implementation keeps and searches anew for every call. The traces are random, with fixed seeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "emulator_models/soft_plc/function_blocks.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr int seeds_count = 200;
constexpr std::size_t calls_count = 120;

struct TimerCall {
  nanoseconds now;
  bool in;
  nanoseconds pt;
};

struct TimerResult {
  bool q;
  nanoseconds et;
};

nanoseconds preset(const TimerCall& call) { return std::max(call.pt, nanoseconds{0}); }

/// @return the first call from `start` on in which PT has passed since `start`; or the number of calls
std::size_t end_of(const std::vector<TimerCall>& calls, std::size_t start) {
  std::size_t i = start;
  while (i < calls.size() && calls[i].now - calls[start].now < preset(calls[i])) ++i;
  return i;
}

/// @return the first call of the unbroken row of calls with this IN that ends with the last call
std::size_t row_start(const std::vector<TimerCall>& calls, bool in) {
  std::size_t i = calls.size();
  while (i > 0 && calls[i - 1].in == in) --i;
  return i;
}

TimerResult measured_from(const std::vector<TimerCall>& calls, std::size_t start, bool q_while_running) {
  const std::size_t end = end_of(calls, start);
  if (end == calls.size()) return {q_while_running, calls.back().now - calls[start].now};
  return {!q_while_running, preset(calls[end])};
}

TimerResult defined_ton(const std::vector<TimerCall>& calls) {
  const std::size_t start = row_start(calls, true);
  if (start == calls.size()) return {false, 0ns};
  return measured_from(calls, start, false);
}

TimerResult defined_tof(const std::vector<TimerCall>& calls) {
  const std::size_t start = row_start(calls, false);
  if (start == calls.size()) return {true, 0ns};
  if (start == 0) return {false, 0ns};
  return measured_from(calls, start, true);
}

TimerResult defined_tp(const std::vector<TimerCall>& calls) {
  std::optional<std::size_t> last_end;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    const bool rises = calls[i].in && (i == 0 || !calls[i - 1].in);
    if (!rises || (last_end && i <= *last_end)) continue;
    const std::size_t end = end_of(calls, i);
    if (end == calls.size()) return {true, calls.back().now - calls[i].now};
    last_end = end;
  }
  if (last_end && row_start(calls, true) <= *last_end) return {false, preset(calls[*last_end])};
  return {false, 0ns};
}

class Random {
 public:
  explicit Random(int seed) : engine_{static_cast<std::uint64_t>(seed)} {}
  int below(int bound) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(bound)); }
  bool one_in(int n) { return below(n) == 0; }

 private:
  std::mt19937_64 engine_;
};

/// Times stand still now and then (two calls in a scan) and jump now and then; PT changes now and then.
std::vector<TimerCall> random_timer_calls(int seed) {
  Random random{seed};
  std::vector<TimerCall> calls;
  TimerCall call{1s, false, 30ms};
  for (std::size_t i = 0; i < calls_count; ++i) {
    if (!random.one_in(5)) call.now += random.one_in(20) ? 200ms : 5ms * (1 + random.below(3));
    if (random.one_in(1 + seed % 6)) call.in = !call.in;
    if (random.one_in(8)) call.pt = 10ms * (random.below(8) - 1);
    calls.push_back(call);
  }
  return calls;
}

template <typename Timer>
void expect_defined(TimerResult (*defined)(const std::vector<TimerCall>&)) {
  for (int seed = 1; seed <= seeds_count; ++seed) {
    Timer timer;
    std::vector<TimerCall> history;
    for (const TimerCall& call : random_timer_calls(seed)) {
      history.push_back(call);
      timer.in = call.in;
      timer.pt = call.pt;
      timer.call(call.now);
      const TimerResult expected = defined(history);
      ASSERT_EQ(timer.q, expected.q) << "seed " << seed << ", call " << history.size();
      ASSERT_EQ(timer.et, expected.et) << "seed " << seed << ", call " << history.size();

      timer.call(call.now);  // I4
      ASSERT_EQ(timer.q, expected.q) << "called again: seed " << seed << ", call " << history.size();
      ASSERT_EQ(timer.et, expected.et) << "called again: seed " << seed << ", call " << history.size();
    }
  }
}

TEST(TimerDefinition, ton_is_on_when_in_has_been_true_for_pt) { expect_defined<Ton>(defined_ton); }
TEST(TimerDefinition, tof_is_on_until_in_has_been_false_for_pt) { expect_defined<Tof>(defined_tof); }
TEST(TimerDefinition, tp_is_on_for_pt_from_a_rise_outside_of_a_pulse) { expect_defined<Tp>(defined_tp); }

/// Four inputs of a block and a preset, as they were in one call.
struct Inputs {
  bool a;
  bool b;
  bool c;
  bool d;
  std::int16_t pv;
};
using History = std::vector<Inputs>;

/// The ranges of the presets cross both ends of INT, so that the limits are reached.
History random_inputs(int seed) {
  constexpr std::int16_t presets[] = {-32768, -32767, -1, 0, 1, 2, 3, 5, 32766, 32767};
  Random random{seed};
  History history;
  Inputs inputs{false, false, false, false, 3};
  for (std::size_t i = 0; i < calls_count; ++i) {
    if (random.one_in(2)) inputs.a = !inputs.a;
    if (random.one_in(2)) inputs.b = !inputs.b;
    inputs.c = random.one_in(12);
    inputs.d = random.one_in(12);
    if (random.one_in(15)) inputs.pv = presets[random.below(static_cast<int>(std::size(presets)))];
    history.push_back(inputs);
  }
  return history;
}

/// @param step  sets the inputs of a block of its own, calls it, and compares it with the history until then
template <typename Block, typename Step>
void for_each_prefix(Step step) {
  for (int seed = 1; seed <= seeds_count; ++seed) {
    Block block;
    History history;
    for (const Inputs& inputs : random_inputs(seed)) {
      history.push_back(inputs);
      step(block, history);
      if (testing::Test::HasFailure()) FAIL() << "seed " << seed << ", call " << history.size();
    }
  }
}

bool rises(const History& history, std::size_t i, bool Inputs::* input) {
  return history[i].*input && (i == 0 || !(history[i - 1].*input));
}

TEST(EdgeDefinition, r_trig_and_f_trig_compare_two_calls) {
  for_each_prefix<std::pair<RTrig, FTrig>>([](auto& blocks, const History& history) {
    auto& [rise, fall] = blocks;
    rise.clk = fall.clk = history.back().a;
    rise.call();
    fall.call();
    const std::size_t last = history.size() - 1;
    EXPECT_EQ(rise.q, rises(history, last, &Inputs::a));
    EXPECT_EQ(fall.q, !history[last].a && (last == 0 || history[last - 1].a));
  });
}

TEST(BistableDefinition, the_latest_input_that_counts_decides) {
  for_each_prefix<std::pair<Sr, Rs>>([](auto& blocks, const History& history) {
    auto& [sr, rs] = blocks;
    sr.s1 = rs.s = history.back().c;
    sr.r = rs.r1 = history.back().d;
    sr.call();
    rs.call();
    const auto latest =
        std::find_if(history.rbegin(), history.rend(), [](const Inputs& i) { return i.c || i.d; });
    EXPECT_EQ(sr.q1, latest != history.rend() && latest->c);
    EXPECT_EQ(rs.q1, latest != history.rend() && !latest->d);
  });
}

/// What a counter must show: the edges since the latest call that set it, each kept within INT.
/// @param set    the value that call i sets, if it sets one
/// @param delta  +1, -1 or 0, what the edges of call i count
template <typename Set, typename Delta>
int defined_count(const History& history, Set set, Delta delta) {
  std::size_t i = history.size();
  while (i > 0 && !set(history[i - 1])) --i;
  int value = i == 0 ? 0 : *set(history[i - 1]);
  for (; i < history.size(); ++i) value = std::clamp(value + delta(i), -32768, 32767);
  return value;
}

TEST(CounterDefinition, ctu_shows_the_rises_since_the_latest_reset) {
  // Counting from zero never comes near 32767: the memory is set there, as a retained one would be.
  for (const int from : {0, 32760}) {
    for_each_prefix<Ctu>([from](Ctu& counter, const History& history) {
      if (history.size() == 1) counter.cv = static_cast<std::int16_t>(from);
      counter.cu = history.back().a;
      counter.r = history.back().c;
      counter.pv = history.back().pv;
      counter.call();
      bool was_reset = false;
      int expected = from;
      for (std::size_t i = 0; i < history.size(); ++i) {
        was_reset = was_reset || history[i].c;
        if (!was_reset && rises(history, i, &Inputs::a)) expected = std::min(expected + 1, 32767);
      }
      if (was_reset) {
        expected = defined_count(
            history, [](const Inputs& inputs) { return inputs.c ? std::optional{0} : std::nullopt; },
            [&](std::size_t i) { return rises(history, i, &Inputs::a) ? 1 : 0; });
      }
      EXPECT_EQ(counter.cv, expected);
      EXPECT_EQ(counter.q, expected >= history.back().pv);
    });
  }
}

TEST(CounterDefinition, ctd_shows_the_preset_less_the_rises_since_the_latest_load) {
  for_each_prefix<Ctd>([](Ctd& counter, const History& history) {
    counter.cd = history.back().a;
    counter.ld = history.back().c;
    counter.pv = history.back().pv;
    counter.call();
    const int expected = defined_count(
        history, [](const Inputs& inputs) { return inputs.c ? std::optional<int>{inputs.pv} : std::nullopt; },
        [&](std::size_t i) { return rises(history, i, &Inputs::a) ? -1 : 0; });
    EXPECT_EQ(counter.cv, expected);
    EXPECT_EQ(counter.q, expected <= 0);
  });
}

TEST(CounterDefinition, ctud_shows_the_difference_of_the_rises_since_the_latest_reset_or_load) {
  for_each_prefix<Ctud>([](Ctud& counter, const History& history) {
    counter.cu = history.back().a;
    counter.cd = history.back().b;
    counter.r = history.back().c;
    counter.ld = history.back().d;
    counter.pv = history.back().pv;
    counter.call();
    const int expected = defined_count(
        history,
        [](const Inputs& inputs) -> std::optional<int> {
          if (inputs.c) return 0;
          if (inputs.d) return inputs.pv;
          return std::nullopt;
        },
        [&](std::size_t i) {
          return int{rises(history, i, &Inputs::a)} - int{rises(history, i, &Inputs::b)};
        });
    EXPECT_EQ(counter.cv, expected);
    EXPECT_EQ(counter.qu, expected >= history.back().pv);
    EXPECT_EQ(counter.qd, expected <= 0);
  });
}

}  // namespace
}  // namespace emulator_models::soft_plc
