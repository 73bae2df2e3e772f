#include "emulator_models/plants/machine_tool_plant.hpp"

namespace emulator_models {

using machine_tool::X;

void MachineToolPlant::advance(Terminals& terminals, SteadyTime now) noexcept {
  const bool powered = emergency_stop_.advance(terminals, now);
  spindle_.advance(terminals, powered, now);
  changer_.advance(terminals, powered, now);
  coolant_.advance(terminals, powered, now);
  hydraulics_.advance(terminals, powered, now);
  lubrication_.advance(terminals, powered, now);
  door_.advance(terminals, now);
  terminals.inputs.set(index_of(X::door_button), door_button_pressed_);
  terminals.inputs.set(index_of(X::reset_button), reset_pressed_);
  terminals.inputs |= stuck_on_;
  terminals.inputs &= ~stuck_off_;
}

void MachineToolPlant::set_failure(MachineToolFailure failure, bool on) noexcept {
  switch (failure) {
    case MachineToolFailure::spindle_drive_fault:
      return spindle_.set_drive_broken(on);
    case MachineToolFailure::flood_without_flow:
      return coolant_.set_flood_blocked(on);
    case MachineToolFailure::mist_without_flow:
      return coolant_.set_mist_blocked(on);
    case MachineToolFailure::coolant_level_low:
      return coolant_.set_level_low(on);
    case MachineToolFailure::coolant_motor_overload:
      return coolant_.set_motor_overload(on);
    case MachineToolFailure::hydraulic_pressure_missing:
      return hydraulics_.set_pressure_missing(on);
    case MachineToolFailure::hydraulic_motor_overload:
      return hydraulics_.set_motor_overload(on);
    case MachineToolFailure::chuck_stuck:
      return hydraulics_.set_chuck_stuck(on);
    case MachineToolFailure::lubrication_pressure_missing:
      return lubrication_.set_pressure_missing(on);
    case MachineToolFailure::lubrication_level_low:
      return lubrication_.set_level_low(on);
    case MachineToolFailure::door_lock_broken:
      return door_.set_lock_broken(on);
    case MachineToolFailure::over_travel:
      return emergency_stop_.set_over_travel(on);
    case MachineToolFailure::drives_not_ready:
      return emergency_stop_.set_drives_not_ready(on);
    case MachineToolFailure::magazine_motor_overload:
      return changer_.set_magazine_overload(on);
    case MachineToolFailure::magazine_stuck:
      return changer_.set_magazine_stuck(on);
    case MachineToolFailure::pocket_pulse_lost:
      return changer_.set_pulse_lost(on);
    case MachineToolFailure::pocket_stuck:
      return changer_.set_pocket_stuck(on);
    case MachineToolFailure::arm_stuck:
      return changer_.set_arm_stuck(on);
    case MachineToolFailure::tool_clamp_stuck:
      return changer_.set_clamp_stuck(on);
  }
}

}  // namespace emulator_models
