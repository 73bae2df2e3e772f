// I19 to I26 of an FX PLC, judged from outside, step by step: by the times at which it was advanced, by its
// terminals, and by its memory between two scans.
//
//   I19  in STOP every output is off
//   I20  a scan of RUN that lasts longer than the watchdog allows, or begins so much too late, writes nothing more
//   I21  the watchdog bites for no other reason
//   I23  the input image is what was latched when the scan began
//   I24  outputs change when a scan writes them all, or to the safe set; they are those of the program
//   I25  each RUN after a STOP begins with an initialisation and one first scan
//   I26  no scan begins before its point of the grid
//
// I22 is in I20: the limit counts from the begin of the scan, whatever has come to its end since. The grid is that of
// the configured period: a program that sets M8039 is not for this monitor.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "emulator_models/fx_plc.hpp"
#include "sim_clock/world/world.hpp"

namespace scenarios {

class FxPlcMonitor {
 public:
  /// @param power_up  when the first scan is due
  FxPlcMonitor(ltsim::World& world, std::chrono::nanoseconds period, std::chrono::nanoseconds watchdog_limit,
               emulator_models::SteadyTime power_up)
      : world_{world}, period_{period}, limit_{watchdog_limit}, power_up_{power_up} {}

  /// After each FxPlc::advance().
  /// @param now  that it was given
  void advanced(const emulator_models::FxPlc& plc, const emulator_models::soft_plc::ScanStep& step,
                emulator_models::SteadyTime now);
  /// Between two scans.
  void look(const emulator_models::FxPlc& plc, emulator_models::DeviceMemory& memory);

 private:
  using SteadyTime = emulator_models::SteadyTime;
  using RunMode = emulator_models::soft_plc::RunMode;

  void judge_begin(SteadyTime now);
  void judge_fault(const emulator_models::FxPlc& plc, SteadyTime now);
  void judge_outputs(const emulator_models::Terminals& terminals, RunMode mode,
                     emulator_models::soft_plc::ScanAction action);

  ltsim::World& world_;
  std::chrono::nanoseconds period_;
  std::chrono::nanoseconds limit_;
  SteadyTime power_up_;
  std::int64_t scans_count_ = 0;
  SteadyTime begin_{};             ///< of the latest scan
  std::optional<SteadyTime> end_;  ///< of the latest scan, if that was one of RUN
  bool in_scan_ = false;
  bool initialised_ = false;     ///< since the latest STOP
  bool had_first_scan_ = false;  ///< since then
  RunMode mode_ = RunMode::stop;
  emulator_models::Terminals seen_{};
};

}  // namespace scenarios
