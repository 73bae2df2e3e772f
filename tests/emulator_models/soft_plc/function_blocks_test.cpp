// The standard function blocks: their tables, and each choice of function_blocks.md.
#include "emulator_models/soft_plc/function_blocks.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <span>
#include <vector>

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr std::int16_t int_max = std::numeric_limits<std::int16_t>::max();
constexpr std::int16_t int_min = std::numeric_limits<std::int16_t>::min();

/// Sets IN and calls.
template <typename Timer>
bool at(Timer& timer, nanoseconds now, bool in) {
  timer.in = in;
  timer.call(now);
  return timer.q;
}

/// Sets CLK and calls.
template <typename Edge>
bool clock(Edge& edge, bool clk) {
  edge.clk = clk;
  edge.call();
  return edge.q;
}

TEST(Bistable, sr_follows_its_table_and_set_wins) {
  for (const bool before : {false, true}) {
    for (const bool s1 : {false, true}) {
      for (const bool r : {false, true}) {
        Sr block{.s1 = s1, .r = r, .q1 = before};
        block.call();
        EXPECT_EQ(block.q1, s1 ? true : r ? false : before) << before << s1 << r;
      }
    }
  }
}

TEST(Bistable, rs_follows_its_table_and_reset_wins) {
  for (const bool before : {false, true}) {
    for (const bool s : {false, true}) {
      for (const bool r1 : {false, true}) {
        Rs block{.s = s, .r1 = r1, .q1 = before};
        block.call();
        EXPECT_EQ(block.q1, r1 ? false : s ? true : before) << before << s << r1;
      }
    }
  }
}

TEST(Edge, r_trig_is_on_for_the_one_call_after_a_rise) {
  RTrig edge;
  EXPECT_FALSE(clock(edge, false));
  EXPECT_TRUE(clock(edge, true));
  EXPECT_FALSE(clock(edge, true));
  EXPECT_FALSE(clock(edge, false));
  EXPECT_TRUE(clock(edge, true));
}

TEST(Edge, f_trig_is_on_for_the_one_call_after_a_fall) {
  FTrig edge;
  EXPECT_FALSE(clock(edge, true));
  EXPECT_TRUE(clock(edge, false));
  EXPECT_FALSE(clock(edge, false));
  EXPECT_FALSE(clock(edge, true));
  EXPECT_TRUE(clock(edge, false));
}

TEST(Edge, first_call_f_trig_with_clk_false_gives_a_pulse) {
  FTrig edge;
  EXPECT_TRUE(clock(edge, false));
  EXPECT_FALSE(clock(edge, false));
}

TEST(Edge, first_call_r_trig_with_clk_true_gives_a_pulse) {
  RTrig edge;
  EXPECT_TRUE(clock(edge, true));
  EXPECT_FALSE(clock(edge, true));
}

TEST(Edge, called_twice_in_a_scan_an_edge_block_ends_its_pulse) {
  RTrig edge;
  clock(edge, false);
  EXPECT_TRUE(clock(edge, true));
  edge.call();
  EXPECT_FALSE(edge.q);
}

TEST(Counter, ctu_counts_rises_and_q_is_on_from_pv_on) {
  Ctu counter{.pv = 2};
  const auto count = [&](bool cu) {
    counter.cu = cu;
    counter.call();
    return counter.cv;
  };
  EXPECT_EQ(count(true), 1);  // TRUE in the first call is a rise
  EXPECT_FALSE(counter.q);
  EXPECT_EQ(count(true), 1);
  EXPECT_EQ(count(false), 1);
  EXPECT_EQ(count(true), 2);
  EXPECT_TRUE(counter.q);
}

TEST(Counter, ctu_reset_wins_over_an_edge_and_uses_it_up) {
  Ctu counter{.cu = true, .pv = 1, .cv = 7};
  counter.r = true;
  counter.call();
  EXPECT_EQ(counter.cv, 0);
  EXPECT_FALSE(counter.q);
  counter.r = false;
  counter.call();
  EXPECT_EQ(counter.cv, 0);
}

TEST(Counter, ctu_limit_counts_on_beyond_pv_up_to_the_maximum_of_int) {
  Ctu counter{.pv = 1};
  const auto pulse = [&] {
    for (const bool cu : {false, true}) {
      counter.cu = cu;
      counter.call();
    }
  };
  for (int i = 0; i < 5; ++i) pulse();
  EXPECT_EQ(counter.cv, 5);
  counter.cv = int_max - 1;
  pulse();
  EXPECT_EQ(counter.cv, int_max);
  pulse();
  EXPECT_EQ(counter.cv, int_max);
  EXPECT_TRUE(counter.q);
}

TEST(Counter, ctd_counts_rises_not_falls_and_q_is_on_at_zero_and_below) {
  Ctd counter{.ld = true, .pv = 2};
  counter.call();
  EXPECT_EQ(counter.cv, 2);
  EXPECT_FALSE(counter.q);
  counter.ld = false;
  std::vector<int> values;
  for (const bool cd : {true, false, true, false, true}) {
    counter.cd = cd;
    counter.call();
    values.push_back(counter.cv);
    EXPECT_EQ(counter.q, counter.cv <= 0);
  }
  EXPECT_EQ(values, (std::vector<int>{1, 1, 0, 0, -1}));
}

TEST(Counter, ctd_load_wins_over_an_edge_and_uses_it_up) {
  Ctd counter{.cd = true, .ld = true, .pv = 4};
  counter.call();
  EXPECT_EQ(counter.cv, 4);
  counter.ld = false;
  counter.call();
  EXPECT_EQ(counter.cv, 4);
}

TEST(Counter, ctd_limit_is_the_minimum_of_int) {
  Ctd counter{.cv = int_min + 1};
  for (const bool cd : {true, false, true}) {
    counter.cd = cd;
    counter.call();
    EXPECT_EQ(counter.cv, int_min);
  }
}

TEST(Counter, ctud_reset_wins_over_load_and_load_over_edges) {
  Ctud counter{.cu = true, .r = true, .ld = true, .pv = 5, .cv = 9};
  counter.call();
  EXPECT_EQ(counter.cv, 0);
  EXPECT_TRUE(counter.qd);
  EXPECT_FALSE(counter.qu);
  counter.r = false;
  counter.cd = true;
  counter.call();
  EXPECT_EQ(counter.cv, 5);
  EXPECT_TRUE(counter.qu);
  EXPECT_FALSE(counter.qd);
}

TEST(Counter, ctud_edges_of_both_inputs_in_one_call_cancel) {
  Ctud counter{.cu = true, .cd = true, .pv = 5, .cv = 3};
  counter.call();
  EXPECT_EQ(counter.cv, 3);
  counter.cu = counter.cd = false;
  counter.call();
  counter.cu = true;
  counter.call();
  EXPECT_EQ(counter.cv, 4);
  counter.cd = true;  // CU stays TRUE: one edge only
  counter.call();
  EXPECT_EQ(counter.cv, 3);
}

TEST(Counter, ctud_limits_are_those_of_int) {
  Ctud counter{.cu = true, .cv = int_max};
  counter.call();
  EXPECT_EQ(counter.cv, int_max);
  counter = {.cd = true, .cv = int_min};
  counter.call();
  EXPECT_EQ(counter.cv, int_min);
}

TEST(Counter, called_twice_in_a_scan_a_counter_counts_an_edge_once) {
  Ctu counter{.cu = true, .pv = 9};
  counter.call();
  counter.call();
  EXPECT_EQ(counter.cv, 1);
}

/// Q and ET of the three timers at one moment of a trace.
struct Row {
  nanoseconds t;
  bool in;
  bool ton_q;
  nanoseconds ton_et;
  bool tp_q;
  nanoseconds tp_et;
  bool tof_q;
  nanoseconds tof_et;
};

void expect_trace(std::span<const Row> rows) {
  Ton ton{.pt = 30ms};
  Tp tp{.pt = 30ms};
  Tof tof{.pt = 30ms};
  for (const Row& row : rows) {
    SCOPED_TRACE(row.t / 1ms);
    EXPECT_EQ(at(ton, row.t, row.in), row.ton_q);
    EXPECT_EQ(ton.et, row.ton_et);
    EXPECT_EQ(at(tp, row.t, row.in), row.tp_q);
    EXPECT_EQ(tp.et, row.tp_et);
    EXPECT_EQ(at(tof, row.t, row.in), row.tof_q);
    EXPECT_EQ(tof.et, row.tof_et);
  }
}

// Started from a run of the compiled blocks of matiec, scan 10 ms, PT = 30 ms.
TEST(Timer, the_reference_trace_holds_in_every_row_and_column) {
  constexpr Row rows[] = {
      // t   IN    TON         TP          TOF
      {0ms, 0, 0, 0ms, 0, 0ms, 0, 0ms},     //
      {10ms, 1, 0, 0ms, 1, 0ms, 1, 0ms},    //
      {20ms, 1, 0, 10ms, 1, 10ms, 1, 0ms},  //
      {30ms, 1, 0, 20ms, 1, 20ms, 1, 0ms},  //
      {40ms, 1, 1, 30ms, 0, 30ms, 1, 0ms},  //
      {50ms, 1, 1, 30ms, 0, 30ms, 1, 0ms},  //
      {60ms, 0, 0, 0ms, 0, 0ms, 1, 0ms},    //
      {70ms, 0, 0, 0ms, 0, 0ms, 1, 10ms},   //
      {80ms, 1, 0, 0ms, 1, 0ms, 1, 0ms},    //
      {90ms, 1, 0, 10ms, 1, 10ms, 1, 0ms},  //
      {100ms, 0, 0, 0ms, 1, 20ms, 1, 0ms},  //
      {110ms, 0, 0, 0ms, 0, 0ms, 1, 10ms},  //
      {120ms, 0, 0, 0ms, 0, 0ms, 1, 20ms},  //
  };
  expect_trace(rows);
}

TEST(Timer, the_trace_of_one_pulse_of_10_ms_holds) {
  constexpr Row rows[] = {
      {0ms, 0, 0, 0ms, 0, 0ms, 0, 0ms},     //
      {10ms, 1, 0, 0ms, 1, 0ms, 1, 0ms},    //
      {20ms, 0, 0, 0ms, 1, 10ms, 1, 0ms},   //
      {30ms, 0, 0, 0ms, 1, 20ms, 1, 10ms},  //
      {40ms, 0, 0, 0ms, 0, 0ms, 1, 20ms},   //
      {50ms, 0, 0, 0ms, 0, 0ms, 0, 30ms},   //
      {60ms, 0, 0, 0ms, 0, 0ms, 0, 30ms},   //
      {70ms, 1, 0, 0ms, 1, 0ms, 1, 0ms},    //
  };
  expect_trace(rows);
}

// I1
TEST(Timer, the_delay_is_pt_to_the_nanosecond_and_rounded_up_to_a_call) {
  Ton ton{.pt = 30ms};
  at(ton, 10ms, true);
  EXPECT_FALSE(at(ton, 40ms - 1ns, true));
  EXPECT_EQ(ton.et, 30ms - 1ns);
  EXPECT_TRUE(at(ton, 40ms, true));

  Tof tof{.pt = 30ms};
  at(tof, 0ms, true);
  at(tof, 10ms, false);
  EXPECT_TRUE(at(tof, 40ms - 1ns, false));
  EXPECT_FALSE(at(tof, 57ms, false));
  EXPECT_EQ(tof.et, 30ms);

  Tp tp{.pt = 30ms};
  at(tp, 10ms, true);
  EXPECT_TRUE(at(tp, 40ms - 1ns, true));
  EXPECT_FALSE(at(tp, 57ms, true));
  EXPECT_EQ(tp.et, 30ms);
}

TEST(Timer, a_first_call_with_in_true_starts_and_does_not_finish) {
  Ton ton{.pt = 30ms};
  EXPECT_FALSE(at(ton, 1h, true));
  EXPECT_EQ(ton.et, 0ms);
  Tp tp{.pt = 30ms};
  EXPECT_TRUE(at(tp, 1h, true));
}

TEST(Timer, a_tof_that_never_saw_in_true_stays_off) {
  Tof tof{.pt = 30ms};
  EXPECT_FALSE(at(tof, 1h, false));
  EXPECT_FALSE(at(tof, 2h, false));
  EXPECT_EQ(tof.et, 0ms);
}

TEST(Timer, an_instance_that_is_not_called_keeps_its_outputs_and_sees_the_time_at_its_next_call) {
  Ton ton{.pt = 30ms};
  at(ton, 0ms, true);
  at(ton, 10ms, true);
  EXPECT_EQ(ton.et, 10ms);
  EXPECT_TRUE(at(ton, 1h, true));
  EXPECT_EQ(ton.et, 30ms);
}

TEST(Timer, edges_during_a_pulse_do_not_extend_it) {
  Tp tp{.pt = 50ms};
  for (int t = 0; t < 5; ++t) EXPECT_TRUE(at(tp, t * 10ms, t % 2 == 0)) << t;
  EXPECT_FALSE(at(tp, 50ms, false));
}

TEST(Timer, pt_zero_ton_is_on_in_the_call_that_sees_in) {
  Ton ton;
  EXPECT_TRUE(at(ton, 0ms, true));
  EXPECT_EQ(ton.et, 0ms);
  EXPECT_FALSE(at(ton, 0ms, false));
}

TEST(Timer, pt_zero_tof_follows_in) {
  Tof tof;
  EXPECT_TRUE(at(tof, 0ms, true));
  EXPECT_FALSE(at(tof, 10ms, false));
  EXPECT_EQ(tof.et, 0ms);
}

TEST(Timer, pt_zero_tp_gives_no_pulse) {
  Tp tp;
  EXPECT_FALSE(at(tp, 0ms, true));
  EXPECT_FALSE(at(tp, 10ms, true));
  EXPECT_FALSE(at(tp, 20ms, false));
  EXPECT_FALSE(at(tp, 30ms, true));
  EXPECT_EQ(tp.et, 0ms);
}

TEST(Timer, pt_negative_counts_as_zero) {
  Ton ton{.pt = -5ms};
  EXPECT_TRUE(at(ton, 10ms, true));
  EXPECT_EQ(ton.et, 0ms);
  Tof tof{.pt = -5ms};
  at(tof, 10ms, true);
  EXPECT_FALSE(at(tof, 20ms, false));
  EXPECT_EQ(tof.et, 0ms);
  Tp tp{.pt = -5ms};
  EXPECT_FALSE(at(tp, 10ms, true));
  EXPECT_EQ(tp.et, 0ms);
}

TEST(Timer, edge_in_the_call_in_which_a_tp_ends_is_swallowed) {
  Tp tp{.pt = 30ms};
  const bool in[] = {false, true, true, false, true, true, false, true};
  const bool q[] = {false, true, true, true, false, false, false, true};
  const nanoseconds et[] = {0ms, 0ms, 10ms, 20ms, 30ms, 30ms, 0ms, 0ms};
  for (std::size_t i = 0; i < std::size(in); ++i) {
    EXPECT_EQ(at(tp, i * 10ms, in[i]), q[i]) << i;
    EXPECT_EQ(tp.et, et[i]) << i;
  }
}

TEST(Timer, pt_changed_while_running_counts_from_the_next_call_on) {
  Ton ton{.pt = 30ms};
  at(ton, 0ms, true);
  ton.pt = 50ms;
  EXPECT_FALSE(at(ton, 40ms, true));
  EXPECT_EQ(ton.et, 40ms);
  ton.pt = 20ms;
  EXPECT_TRUE(at(ton, 41ms, true));
  EXPECT_EQ(ton.et, 20ms);

  Tp tp{.pt = 30ms};
  at(tp, 0ms, true);
  tp.pt = 50ms;
  EXPECT_TRUE(at(tp, 40ms, true));
  tp.pt = 10ms;
  EXPECT_FALSE(at(tp, 41ms, true));
  EXPECT_EQ(tp.et, 10ms);

  Tof tof{.pt = 30ms};
  at(tof, 0ms, true);
  at(tof, 0ms, false);
  tof.pt = 50ms;
  EXPECT_TRUE(at(tof, 40ms, false));
  tof.pt = 10ms;
  EXPECT_FALSE(at(tof, 41ms, false));
  EXPECT_EQ(tof.et, 10ms);
}

// I3
TEST(Timer, pt_changed_after_the_end_changes_nothing) {
  Ton ton{.pt = 30ms};
  Tp tp{.pt = 30ms};
  Tof tof{.pt = 30ms, .q = true};
  for (const nanoseconds t : {0ms, 30ms}) {
    at(ton, t, true);
    at(tp, t, true);
    at(tof, t, false);
  }
  for (const nanoseconds pt : {nanoseconds{1h}, nanoseconds{0}}) {
    ton.pt = tp.pt = tof.pt = pt;
    EXPECT_TRUE(at(ton, 40ms, true));
    EXPECT_FALSE(at(tp, 40ms, true));
    EXPECT_FALSE(at(tof, 40ms, false));
    EXPECT_EQ(ton.et, 30ms);
    EXPECT_EQ(tp.et, 30ms);
    EXPECT_EQ(tof.et, 30ms);
  }
}

TEST(Timer, called_twice_in_a_scan_a_timer_sees_no_time_but_sees_its_input) {
  Ton ton{.pt = 30ms};
  at(ton, 0ms, true);
  at(ton, 30ms, true);
  EXPECT_TRUE(at(ton, 30ms, true));
  EXPECT_FALSE(at(ton, 30ms, false));
  EXPECT_FALSE(at(ton, 30ms, true));  // starts anew, at 30 ms
  EXPECT_FALSE(at(ton, 59ms, true));
  EXPECT_TRUE(at(ton, 60ms, true));

  Tp tp{.pt = 30ms};
  EXPECT_FALSE(at(tp, 10ms, false));
  EXPECT_TRUE(at(tp, 10ms, true));  // a rise between two calls of one scan is a rise
  EXPECT_TRUE(at(tp, 10ms, false));
  EXPECT_EQ(tp.et, 0ms);
}

TEST(Timer, range_of_time_pt_of_292_years_neither_wraps_nor_ends) {
  Ton ton{.pt = nanoseconds::max()};
  at(ton, nanoseconds::min(), true);
  EXPECT_FALSE(at(ton, -2ns, true));
  EXPECT_EQ(ton.et, nanoseconds::max() - 1ns);
  EXPECT_TRUE(at(ton, nanoseconds::max(), true));  // saturated: the true difference has no room
  EXPECT_EQ(ton.et, nanoseconds::max());
}

TEST(Timer, range_of_time_32_bit_milliseconds_are_no_limit) {
  Ton ton{.pt = 24h * 60};
  at(ton, 24h * 40, true);
  EXPECT_FALSE(at(ton, 24h * 100 - 1ns, true));
  EXPECT_TRUE(at(ton, 24h * 100, true));
}

TEST(Timer, a_clock_that_steps_back_counts_as_no_time) {
  Ton ton{.pt = 30ms};
  at(ton, 100ms, true);
  EXPECT_FALSE(at(ton, 10ms, true));
  EXPECT_EQ(ton.et, 0ms);
  EXPECT_TRUE(at(ton, 130ms, true));
}

}  // namespace
}  // namespace emulator_models::soft_plc
