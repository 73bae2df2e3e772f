// The machine tool behind an FX PLC as a scenario runs it: scanned by one task, worked through the programming
// port by another, and watched: after each scan the interlock rules are looked at, and I27.
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

#include "emulator_models/fx_plc.hpp"
#include "emulator_models/plants/machine_tool_rules.hpp"
#include "sim_clock/world/world.hpp"
#include "tests/scenarios/function_monitor.hpp"

namespace scenarios {

/// When the requests of the programming port are served.
enum class PortService {
  at_scan_boundary,  ///< one at a time, in phase 1: each write is seen by a scan before the next one comes
  between_scans,     ///< as they come: several writes can lie between two scans
};

class WatchedMachine {
 public:
  /// @param program  of the machine tool, compiled for an FX3U; must outlive this, as the others
  WatchedMachine(ltsim::World& world, const emulator_models::soft_plc::IlProgram& program,
                 FunctionMonitor& functions, std::chrono::nanoseconds period,
                 PortService service = PortService::at_scan_boundary);

  /// Body of the scanning task, until request_stop().
  void scan();
  void request_stop() noexcept { stop_requested_.store(true); }

  [[nodiscard]] emulator_models::IPlcEmulator& port() noexcept {
    if (service_ == PortService::at_scan_boundary) return port_;
    return emulator_;
  }
  [[nodiscard]] emulator_models::MachineToolPlant& plant() noexcept { return plant_; }
  /// Judges by this rule alone: one mistake can break several, and which of them first is a matter of chance.
  void judge_only(std::string_view rule) { only_ = rule; }

  /// As FxPlc's.
  void observe_with(emulator_models::FxPlcObserver* observer) noexcept { plc_.observe_with(observer); }
  /// What the operator does after an exchange of tools that was cut short: looks where they are, and writes that
  /// into the PLC. Between two scans.
  void put_tool_table_right();

 private:
  void look(emulator_models::SteadyTime now);

  ltsim::World& world_;
  FunctionMonitor& functions_;
  std::chrono::nanoseconds period_;
  PortService service_;
  emulator_models::FxPlcEmulator emulator_{protocol::fx::Model::fx3u};
  emulator_models::ScanBoundaryPort port_{emulator_};
  emulator_models::MachineToolPlant plant_;
  emulator_models::FxPlc plc_;
  emulator_models::MachineToolRules rules_;
  std::string only_;  ///< empty: all
  /// Time as the rules see it: it goes on by one period a scan at most. The program can only react when it is
  /// scanned, and a world may let a scan come late.
  emulator_models::SteadyTime scanned_time_{};
  emulator_models::SteadyTime last_look_{};
  std::atomic<bool> stop_requested_{false};
};

}  // namespace scenarios
