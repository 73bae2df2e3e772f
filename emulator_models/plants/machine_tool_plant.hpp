// The machine tool behind the terminals: spindle, coolant, tool changer, hydraulics with the chuck, lubrication,
// guard door, emergency-stop chain. Wired as machine_tool_wiring.hpp says; times stand with each unit.
//
// Invariants
//   I1  orders count from the call that sees them on; what they cause happens at its computed moment, and a call
//       shows what has happened until then.
//   I2  the inputs are a function of the calls' times, outputs, failures and hands: there is no chance in here.
//   I3  nothing moves without power, but the spindle runs out and springs return.
// No allocation. Lamps and horn are only wires. Failures and hands count from the next call on.
#pragma once

#include <bitset>
#include <cstdint>

#include "emulator_models/plants/machine_tool_changer.hpp"
#include "emulator_models/plants/machine_tool_fluids.hpp"
#include "emulator_models/plants/machine_tool_guard.hpp"
#include "emulator_models/plants/machine_tool_spindle.hpp"
#include "emulator_models/plants/machine_tool_wiring.hpp"
#include "emulator_models/plants/terminals.hpp"

namespace emulator_models {

enum class MachineToolFailure : std::uint8_t {
  spindle_drive_fault,
  flood_without_flow,
  mist_without_flow,
  coolant_level_low,
  coolant_motor_overload,
  hydraulic_pressure_missing,
  hydraulic_motor_overload,
  chuck_stuck,
  lubrication_pressure_missing,
  lubrication_level_low,
  door_lock_broken,
  over_travel,
  drives_not_ready,
  magazine_motor_overload,
  magazine_stuck,
  pocket_pulse_lost,
  pocket_stuck,
  arm_stuck,
  tool_clamp_stuck,
};
inline constexpr std::size_t machine_tool_failures_count = 19;

class MachineToolPlant {
 public:
  /// Reads the outputs and sets the inputs as they are at `now`.
  /// @param now  never earlier than in the call before
  void advance(Terminals& terminals, SteadyTime now) noexcept;

  void set_failure(MachineToolFailure failure, bool on) noexcept;
  /// A switch that always reports the same, whatever the machine does. Stuck off wins.
  void set_stuck_on(machine_tool::X input, bool on) noexcept { stuck_on_.set(index_of(input), on); }
  void set_stuck_off(machine_tool::X input, bool on) noexcept { stuck_off_.set(index_of(input), on); }

  void set_emergency_stop_pressed(bool pressed) noexcept { emergency_stop_.set_button_pressed(pressed); }
  void set_door_pulled_open(bool pulled) noexcept { door_.set_pulled_open(pulled); }
  void set_door_button_pressed(bool pressed) noexcept { door_button_pressed_ = pressed; }
  void set_reset_pressed(bool pressed) noexcept { reset_pressed_ = pressed; }

  [[nodiscard]] const machine_tool::Spindle& spindle() const noexcept { return spindle_; }
  [[nodiscard]] const machine_tool::ToolChanger& changer() const noexcept { return changer_; }
  [[nodiscard]] const machine_tool::Coolant& coolant() const noexcept { return coolant_; }
  [[nodiscard]] const machine_tool::Hydraulics& hydraulics() const noexcept { return hydraulics_; }
  [[nodiscard]] const machine_tool::GuardDoor& door() const noexcept { return door_; }

 private:
  machine_tool::Spindle spindle_;
  machine_tool::ToolChanger changer_;
  machine_tool::Coolant coolant_;
  machine_tool::Hydraulics hydraulics_;
  machine_tool::Lubrication lubrication_;
  machine_tool::GuardDoor door_;
  machine_tool::EmergencyStop emergency_stop_;
  bool door_button_pressed_ = false;
  bool reset_pressed_ = false;
  std::bitset<Terminals::points_count> stuck_on_;
  std::bitset<Terminals::points_count> stuck_off_;
};

}  // namespace emulator_models
