// The machine tool itself, and who watches it: after each scan the interlock rules are looked at, and I27. Both
// outlive a PLC whose process is killed: relays drop without power, so its outputs are off from then on.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "emulator_models/fx_plc.hpp"
#include "emulator_models/plants/machine_tool_rules.hpp"
#include "sim_clock/world/world.hpp"
#include "tests/scenarios/function_monitor.hpp"

namespace scenarios {

class WatchedPlant {
 public:
  /// @param period  of the scans
  WatchedPlant(ltsim::World& world, FunctionMonitor& functions, std::chrono::nanoseconds period);

  [[nodiscard]] emulator_models::MachineToolPlant& plant() noexcept { return plant_; }
  [[nodiscard]] std::chrono::nanoseconds period() const noexcept { return period_; }
  /// Judges by this rule alone: one mistake can break several, and which of them first is a matter of chance.
  void judge_only(std::string_view rule) { only_ = rule; }

  /// A scan has ended.
  /// @param now  when it began
  void look(const emulator_models::FxPlc& plc, const emulator_models::DeviceMemory& memory,
            emulator_models::SteadyTime now);
  /// The PLC's process is dead, since the last look: the machine goes on without outputs until now.
  void pass_without_plc();

 private:
  void look(const emulator_models::Terminals& terminals, const emulator_models::MachineToolContract& contract,
            emulator_models::SteadyTime now);

  ltsim::World& world_;
  FunctionMonitor& functions_;
  std::chrono::nanoseconds period_;
  emulator_models::MachineToolPlant plant_;
  emulator_models::MachineToolRules rules_;
  std::string only_;  ///< empty: all
  /// Time as the rules see it: it goes on by one period a scan at most. The program can only react when it is
  /// scanned, and a world may let a scan come late.
  emulator_models::SteadyTime scanned_time_{};
  emulator_models::SteadyTime last_look_{};
};

}  // namespace scenarios
