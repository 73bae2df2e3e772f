// The propulsion station behind an FX PLC as a scenario runs it: scanned by one task, worked through the programming
// port by another, and watched: after each scan the rules of the station are looked at, and I19 to I26.
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

#include "emulator_models/fx_plc.hpp"
#include "emulator_models/plants/propulsion_plant.hpp"
#include "emulator_models/plants/propulsion_rules.hpp"
#include "sim_clock/world/world.hpp"
#include "tests/scenarios/fx_plc_monitor.hpp"

namespace scenarios {

class WatchedPropulsion {
 public:
  /// @param program    of the station, compiled for an FX3U; must outlive this, as the world
  /// @param only_rule  the rule to judge by: one mistake can break several, and which of them first is a matter of
  ///                   chance; empty: all, and the PLC's
  WatchedPropulsion(ltsim::World& world, const emulator_models::soft_plc::IlProgram& program,
                    std::chrono::nanoseconds period, std::string_view only_rule);

  /// Body of the scanning task, until request_stop().
  void scan();
  void request_stop() noexcept { stop_requested_.store(true); }

  [[nodiscard]] emulator_models::IPlcEmulator& port() noexcept { return port_; }
  [[nodiscard]] emulator_models::PropulsionPlant& plant() noexcept { return plant_; }

 private:
  void look(emulator_models::SteadyTime scan_start);
  void judge(emulator_models::DeviceMemory& memory, emulator_models::SteadyTime scan_start);

  ltsim::World& world_;
  std::string only_;
  emulator_models::FxPlcEmulator emulator_{protocol::fx::Model::fx3u};
  emulator_models::ScanBoundaryPort port_{emulator_};
  emulator_models::PropulsionPlant plant_;
  emulator_models::FxPlc plc_;
  FxPlcMonitor monitor_;
  emulator_models::PropulsionRules rules_;
  std::atomic<bool> stop_requested_{false};
};

}  // namespace scenarios
