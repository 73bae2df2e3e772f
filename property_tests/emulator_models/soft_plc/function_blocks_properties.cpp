// The standard function blocks against their equations, each told from the whole history of the inputs.

#include <algorithm>
#include <ostream>

#include "emulator_models/soft_plc/function_blocks.hpp"
#include "property_tests/support/property.hpp"

namespace property_tests {
namespace {

using namespace emulator_models::soft_plc;
using std::chrono::nanoseconds;

struct TimerCall {
  nanoseconds now;
  bool in;
};

/// Times as small numbers, so that what is exactly PT is not rare. Two calls may see one time.
struct TimerTrace {
  nanoseconds pt{*rc::gen::inRange(-2, 15)};
  std::vector<TimerCall> calls;

  TimerTrace() {
    nanoseconds now{*rc::gen::inRange(0, 5)};
    for (const auto& [step, in] : *rc::gen::container<std::vector<std::pair<int, bool>>>(
             rc::gen::pair(rc::gen::inRange(0, 9), rc::gen::arbitrary<bool>()))) {
      now += nanoseconds{step};
      calls.push_back({now, in});
    }
  }
  [[nodiscard]] nanoseconds preset() const { return std::max(pt, nanoseconds{0}); }
  /// The first call of the row of equal IN that ends with call `last`.
  [[nodiscard]] std::size_t row_start(std::size_t last) const {
    while (last > 0 && calls[last - 1].in == calls[last].in) --last;
    return last;
  }
};

struct TimerOutputs {
  bool q;
  nanoseconds et;
};

/// TON: Q when IN has been TRUE for PT. ET is how long it has been, PT at most.
TimerOutputs ton(const TimerTrace& trace, std::size_t i) {
  if (!trace.calls[i].in) return {false, nanoseconds{0}};
  const nanoseconds on_for = trace.calls[i].now - trace.calls[trace.row_start(i)].now;
  return {on_for >= trace.preset(), std::min(on_for, trace.preset())};
}

/// TOF: Q while IN, and until it has been FALSE for PT after that.
TimerOutputs tof(const TimerTrace& trace, std::size_t i) {
  if (trace.calls[i].in) return {true, nanoseconds{0}};
  const std::size_t fall = trace.row_start(i);
  if (fall == 0) return {false, nanoseconds{0}};  // it has never been TRUE
  const nanoseconds off_for = trace.calls[i].now - trace.calls[fall].now;
  return {off_for < trace.preset(), std::min(off_for, trace.preset())};
}

/// TP: a pulse of PT begins with each rising IN that lies in none; one that lies in the call that ends one is lost.
TimerOutputs tp(const TimerTrace& trace, std::size_t i) {
  for (std::size_t begin = 0; begin <= i; ++begin) {
    const bool rises = trace.calls[begin].in && (begin == 0 || !trace.calls[begin - 1].in);
    if (!rises) continue;
    std::size_t end = begin;
    while (end <= i && trace.calls[end].now - trace.calls[begin].now < trace.preset()) ++end;
    if (end > i) return {true, trace.calls[i].now - trace.calls[begin].now};
    const bool in_stays = std::all_of(trace.calls.begin() + static_cast<std::ptrdiff_t>(end),
                                      trace.calls.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                      [](const TimerCall& call) { return call.in; });
    if (in_stays) return {false, trace.preset()};
    begin = end;  // a rise in that very call is lost
  }
  return {false, nanoseconds{0}};
}

template <class Timer>
void assert_follows(TimerOutputs (*equation)(const TimerTrace&, std::size_t)) {
  const TimerTrace trace;
  Timer timer;
  timer.pt = trace.pt;
  for (std::size_t i = 0; i < trace.calls.size(); ++i) {
    timer.in = trace.calls[i].in;
    timer.call(trace.calls[i].now);
    const TimerOutputs expected = equation(trace, i);
    RC_ASSERT(timer.q == expected.q);
    RC_ASSERT(timer.et == expected.et);
  }
}

PROPERTY(Ton, follows_its_equation, ()) { assert_follows<Ton>(&ton); }
PROPERTY(Tof, follows_its_equation, ()) { assert_follows<Tof>(&tof); }
PROPERTY(Tp, follows_its_equation, ()) { assert_follows<Tp>(&tp); }

/// With a PT that changes: I2, I3, I4.
template <class Timer>
void assert_keeps_its_invariants() {
  const TimerTrace trace;
  Timer timer;
  nanoseconds preset_while_running{0};
  for (const TimerCall& call : trace.calls) {
    const Timer before = timer;
    timer.in = call.in;
    timer.pt = nanoseconds{*rc::gen::inRange(-3, 15)};
    if (before.phase != TimerPhase::done) preset_while_running = std::max(timer.pt, nanoseconds{0});
    timer.call(call.now);
    RC_ASSERT(timer.et >= nanoseconds{0});
    RC_ASSERT(timer.et <= preset_while_running);  // I2
    if (before.phase == TimerPhase::done && before.in == timer.in) {
      RC_ASSERT(timer.q == before.q);    // I3
      RC_ASSERT(timer.et == before.et);  // I3
    }
    const Timer once = timer;
    timer.call(call.now);
    RC_ASSERT(timer.q == once.q && timer.et == once.et && timer.phase == once.phase);  // I4
  }
}

PROPERTY(Ton, keeps_its_invariants_whatever_becomes_of_pt, ()) { assert_keeps_its_invariants<Ton>(); }
PROPERTY(Tof, keeps_its_invariants_whatever_becomes_of_pt, ()) { assert_keeps_its_invariants<Tof>(); }
PROPERTY(Tp, keeps_its_invariants_whatever_becomes_of_pt, ()) { assert_keeps_its_invariants<Tp>(); }

PROPERTY(EdgeDetectors, see_each_change_of_clk_once, ()) {
  const auto clks = *rc::gen::container<std::string>(rc::gen::element('0', '1'));
  RTrig rising;
  FTrig falling;
  for (std::size_t i = 0; i < clks.size(); ++i) {
    const bool clk = clks[i] == '1';
    rising.clk = falling.clk = clk;
    rising.call();
    falling.call();
    RC_ASSERT(rising.q == (clk && (i == 0 || clks[i - 1] == '0')));
    RC_ASSERT(falling.q == (!clk && (i == 0 || clks[i - 1] == '1')));
  }
}

PROPERTY(Bistables, show_the_latest_order_and_the_dominant_one_of_two,
         (const std::vector<std::pair<bool, bool>>& orders)) {
  Sr sr;
  Rs rs;
  bool set_dominant = false;
  bool reset_dominant = false;
  for (const auto& [set, reset] : orders) {
    sr.s1 = rs.s = set;
    sr.r = rs.r1 = reset;
    sr.call();
    rs.call();
    if (set || reset) {
      set_dominant = set;
      reset_dominant = !reset;
    }
    RC_ASSERT(sr.q1 == set_dominant);
    RC_ASSERT(rs.q1 == reset_dominant);
  }
}

struct CounterCall {
  bool up;
  bool down;
  bool r;
  bool ld;
  std::int16_t pv;
};

void showValue(const CounterCall& call, std::ostream& out) {
  out << (call.up ? "U" : "") << (call.down ? "D" : "") << (call.r ? "R" : "") << (call.ld ? "L" : "")
      << call.pv;
}

/// PV at 0, at the ends of INT, and anywhere.
rc::Gen<CounterCall> any_counter_call() {
  return rc::gen::exec([] {
    const auto one_in_eight = [] { return *rc::gen::inRange(0, 8) == 7; };
    CounterCall call{};
    call.up = *rc::gen::arbitrary<bool>();
    call.down = *rc::gen::arbitrary<bool>();
    call.r = one_in_eight();
    call.ld = one_in_eight();
    call.pv = static_cast<std::int16_t>(*rc::gen::element(0, 0, 32767, -32768) + *rc::gen::inRange(-3, 4));
    return call;
  });
}

constexpr int in_int(int value) { return std::clamp(value, -32768, 32767); }

PROPERTY(Counters, count_edges_within_int_and_r_wins_over_ld_and_that_over_edges, ()) {
  const auto calls = *rc::gen::container<std::vector<CounterCall>>(any_counter_call());
  const int begin = *rc::gen::element(0, 32766, -32767);
  Ctu ctu;
  Ctd ctd;
  Ctud ctud;
  int up_count = begin;
  int down_count = begin;
  int both_count = begin;
  ctu.cv = ctd.cv = ctud.cv = static_cast<std::int16_t>(begin);
  CounterCall before{};
  for (const CounterCall& call : calls) {
    ctu.cu = ctud.cu = call.up;
    ctd.cd = ctud.cd = call.down;
    ctu.r = ctud.r = call.r;
    ctd.ld = ctud.ld = call.ld;
    ctu.pv = ctd.pv = ctud.pv = call.pv;
    ctu.call();
    ctd.call();
    ctud.call();
    const int up = call.up && !before.up ? 1 : 0;
    const int down = call.down && !before.down ? 1 : 0;
    before = call;
    up_count = call.r ? 0 : in_int(up_count + up);
    down_count = call.ld ? call.pv : in_int(down_count - down);
    both_count = call.r ? 0 : call.ld ? call.pv : in_int(both_count + up - down);
    RC_ASSERT(ctu.cv == up_count && ctu.q == (up_count >= call.pv));
    RC_ASSERT(ctd.cv == down_count && ctd.q == (down_count <= 0));
    RC_ASSERT(ctud.cv == both_count && ctud.qu == (both_count >= call.pv) && ctud.qd == (both_count <= 0));
  }
}

}  // namespace
}  // namespace property_tests
