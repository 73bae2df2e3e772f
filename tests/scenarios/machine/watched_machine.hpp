// The machine tool behind an FX PLC as a scenario runs it: scanned by one task, worked through the programming
// port by another, and watched after each scan (watched_plant.hpp).
#pragma once

#include <atomic>
#include <string_view>

#include "emulator_models/fx_plc.hpp"
#include "tests/scenarios/machine/watched_plant.hpp"

namespace scenarios {

/// When the requests of the programming port are served.
enum class PortService {
  at_scan_boundary,  ///< one at a time, in phase 1: each write is seen by a scan before the next one comes
  between_scans,     ///< as they come: several writes can lie between two scans
};

class WatchedMachine {
 public:
  /// The PLC is switched on.
  /// @param program  of the machine tool, compiled for an FX3U; must outlive this, as the plant
  WatchedMachine(WatchedPlant& plant, const emulator_models::soft_plc::IlProgram& program,
                 PortService service = PortService::at_scan_boundary,
                 emulator_models::SteadyTime now = emulator_models::SteadyTime{});

  /// Body of the scanning task, until request_stop().
  void scan();
  void request_stop() noexcept { stop_requested_.store(true); }

  [[nodiscard]] emulator_models::IPlcEmulator& port() noexcept {
    if (service_ == PortService::at_scan_boundary) return port_;
    return emulator_;
  }

  /// As FxPlc's.
  void observe_with(emulator_models::FxPlcObserver* observer) noexcept { plc_.observe_with(observer); }
  /// What the operator does after an exchange of tools that was cut short: looks where they are, and writes that
  /// into the PLC. Between two scans.
  void put_tool_table_right();
  /// What a battery does, before the first scan: the tool table is as the dead PLC has left it. The program has
  /// nothing else that is latched.
  /// @param dead  nobody runs it any more
  void keep_latched(WatchedMachine& dead);

 private:
  void look(emulator_models::SteadyTime now);

  WatchedPlant& plant_;
  PortService service_;
  emulator_models::FxPlcEmulator emulator_{protocol::fx::Model::fx3u};
  emulator_models::ScanBoundaryPort port_{emulator_};
  emulator_models::FxPlc plc_;
  std::atomic<bool> stop_requested_{false};
};

}  // namespace scenarios
