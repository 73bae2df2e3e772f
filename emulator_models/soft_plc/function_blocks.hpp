// The standard function blocks of IEC 61131-3: bistables, edges, counters (INT), timers.
//
// Plain structs. Inputs, outputs and names are those of the standard in lower case; what follows them is the
// memory of the instance. A program sets the inputs, calls, and reads the outputs. An instance that is not
// called keeps its outputs and sees neither time nor edges. Time is sampled by the caller, once a scan: all
// timers of a scan get the same `now`.
//
// Invariants
//   I1  a timer is done when now - start >= PT, in the very call in which that becomes true: PT is rounded up
//       to calls, never down.
//   I2  0 <= ET <= the PT of the last call in which the timer ran, where a negative PT counts as 0.
//   I3  once done, a timer keeps Q and ET until its input changes, whatever happens to PT.
//   I4  a timer called again with the same inputs and the same `now` changes nothing.
//   I5  no counter leaves the range of INT.
//
// Where the standard is silent: function_blocks.md.
#pragma once

#include <chrono>
#include <cstdint>

namespace emulator_models::soft_plc {

/// Set dominant: Q1 := S1 OR (NOT R AND Q1).
struct Sr {
  bool s1 = false;
  bool r = false;
  bool q1 = false;

  void call() noexcept;
};

/// Reset dominant: Q1 := NOT R1 AND (S OR Q1).
struct Rs {
  bool s = false;
  bool r1 = false;
  bool q1 = false;

  void call() noexcept;
};

/// Q for one call after CLK has risen; CLK TRUE in the first call counts as risen.
struct RTrig {
  bool clk = false;
  bool q = false;
  bool m = false;  ///< CLK of the call before

  void call() noexcept;
};

/// Q for one call after CLK has fallen; CLK FALSE in the first call counts as fallen.
struct FTrig {
  bool clk = false;
  bool q = false;
  bool m = false;  ///< NOT CLK of the call before

  void call() noexcept;
};

/// Counts up on rising CU until 32767; R wins. Q := CV >= PV.
struct Ctu {
  bool cu = false;
  bool r = false;
  std::int16_t pv = 0;
  bool q = false;
  std::int16_t cv = 0;
  RTrig cu_edge{};

  void call() noexcept;
};

/// Counts down on rising CD until -32768; LD (CV := PV) wins. Q := CV <= 0.
struct Ctd {
  bool cd = false;
  bool ld = false;
  std::int16_t pv = 0;
  bool q = false;
  std::int16_t cv = 0;
  RTrig cd_edge{};

  void call() noexcept;
};

/// Counts both ways; R wins over LD, LD over edges; both edges in one call cancel. QU := CV >= PV, QD := CV <= 0.
struct Ctud {
  bool cu = false;
  bool cd = false;
  bool r = false;
  bool ld = false;
  std::int16_t pv = 0;
  bool qu = false;
  bool qd = false;
  std::int16_t cv = 0;
  RTrig cu_edge{};
  RTrig cd_edge{};

  void call() noexcept;
};

enum class TimerPhase : std::uint8_t { idle, running, done };

/// Delays switching on: Q when IN has been TRUE for PT; IN FALSE clears Q and ET in the same call.
struct Ton {
  bool in = false;
  std::chrono::nanoseconds pt{0};
  bool q = false;
  std::chrono::nanoseconds et{0};
  TimerPhase phase = TimerPhase::idle;
  std::chrono::nanoseconds start{0};

  /// @param now  since any fixed moment, never earlier than in the call before
  void call(std::chrono::nanoseconds now) noexcept;
};

/// Delays switching off: Q falls when IN has been FALSE for PT. ET stays at PT until IN rises.
struct Tof {
  bool in = false;
  std::chrono::nanoseconds pt{0};
  bool q = false;
  std::chrono::nanoseconds et{0};
  TimerPhase phase = TimerPhase::idle;
  std::chrono::nanoseconds start{0};

  /// @param now  as for Ton
  void call(std::chrono::nanoseconds now) noexcept;
};

/// Pulse: Q for PT from a rising IN on, whatever IN does meanwhile. ET stays at PT while IN stays TRUE, and
/// is 0 when the pulse is over and IN is FALSE.
struct Tp {
  bool in = false;
  std::chrono::nanoseconds pt{0};
  bool q = false;
  std::chrono::nanoseconds et{0};
  TimerPhase phase = TimerPhase::idle;
  std::chrono::nanoseconds start{0};

  /// @param now  as for Ton
  void call(std::chrono::nanoseconds now) noexcept;
};

}  // namespace emulator_models::soft_plc
