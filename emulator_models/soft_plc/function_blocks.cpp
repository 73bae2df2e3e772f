#include "emulator_models/soft_plc/function_blocks.hpp"

#include <algorithm>
#include <limits>

namespace emulator_models::soft_plc {
namespace {

using std::chrono::nanoseconds;

/// @return now - start within 0 and the largest duration: a clock that steps back, or a difference that has
///         no room, must neither end a timer at once nor overflow
nanoseconds elapsed(nanoseconds start, nanoseconds now) noexcept {
  if (now <= start) return nanoseconds{0};
  const auto difference = static_cast<std::uint64_t>(now.count()) - static_cast<std::uint64_t>(start.count());
  const auto limit = static_cast<std::uint64_t>(nanoseconds::max().count());
  return nanoseconds{static_cast<std::int64_t>(std::min(difference, limit))};
}

template <typename Timer>
void begin(Timer& timer, nanoseconds now) noexcept {
  timer.phase = TimerPhase::running;
  timer.start = now;
}

/// One look at a running timer: ET follows the time, and the timer is done when that has reached PT.
template <typename Timer>
void advance(Timer& timer, nanoseconds now) noexcept {
  const nanoseconds preset = std::max(timer.pt, nanoseconds{0});
  const nanoseconds since_start = elapsed(timer.start, now);
  timer.et = std::min(since_start, preset);
  if (since_start >= preset) timer.phase = TimerPhase::done;
}

void count_up(std::int16_t& value) noexcept {
  if (value < std::numeric_limits<std::int16_t>::max()) ++value;
}

void count_down(std::int16_t& value) noexcept {
  if (value > std::numeric_limits<std::int16_t>::min()) --value;
}

bool risen(RTrig& edge, bool clk) noexcept {
  edge.clk = clk;
  edge.call();
  return edge.q;
}

}  // namespace

void Sr::call() noexcept { q1 = s1 || (!r && q1); }

void Rs::call() noexcept { q1 = !r1 && (s || q1); }

void RTrig::call() noexcept {
  q = clk && !m;
  m = clk;
}

void FTrig::call() noexcept {
  q = !clk && !m;
  m = !clk;
}

void Ctu::call() noexcept {
  const bool up = risen(cu_edge, cu);
  if (r) {
    cv = 0;
  } else if (up) {
    count_up(cv);
  }
  q = cv >= pv;
}

void Ctd::call() noexcept {
  const bool down = risen(cd_edge, cd);
  if (ld) {
    cv = pv;
  } else if (down) {
    count_down(cv);
  }
  q = cv <= 0;
}

void Ctud::call() noexcept {
  const bool up = risen(cu_edge, cu);
  const bool down = risen(cd_edge, cd);
  if (r) {
    cv = 0;
  } else if (ld) {
    cv = pv;
  } else if (up && !down) {
    count_up(cv);
  } else if (down && !up) {
    count_down(cv);
  }
  qu = cv >= pv;
  qd = cv <= 0;
}

void Ton::call(nanoseconds now) noexcept {
  if (!in) {
    phase = TimerPhase::idle;
    et = nanoseconds{0};
  } else {
    if (phase == TimerPhase::idle) begin(*this, now);
#ifdef LTSIM_MUTANT_TIMER_WRAPS  // ET goes on, in milliseconds of 32 bits, and Q follows it
    const std::chrono::milliseconds wrapped{
        static_cast<std::int32_t>((now - start) / std::chrono::milliseconds{1})};
    phase = TimerPhase::running;
    advance(*this, start + wrapped);
#else
    if (phase == TimerPhase::running) advance(*this, now);
#endif
  }
  q = phase == TimerPhase::done;
}

void Tof::call(nanoseconds now) noexcept {
  if (in) {
    phase = TimerPhase::idle;
    et = nanoseconds{0};
    q = true;
    return;
  }
  // Idle with Q FALSE: IN has never been TRUE, so nothing has fallen.
  if (phase == TimerPhase::idle && q) begin(*this, now);
  if (phase == TimerPhase::running) advance(*this, now);
  q = phase == TimerPhase::running;
}

void Tp::call(nanoseconds now) noexcept {
  // Idle is left by the first TRUE, and entered with FALSE only: TRUE in idle is a rising edge.
  if (phase == TimerPhase::idle && in) begin(*this, now);
  if (phase == TimerPhase::running) advance(*this, now);
  if (phase == TimerPhase::done && !in) {
    phase = TimerPhase::idle;
    et = nanoseconds{0};
  }
  q = phase == TimerPhase::running;
}

}  // namespace emulator_models::soft_plc
