#include "emulator_models/machine_plant.hpp"

#include "emulator_models/machine_devices.hpp"

namespace emulator_models {

bool MachinePlant::OnDelay::update(bool condition, SteadyTime now) noexcept {
  if (!condition) {
    since_.reset();
    return false;
  }
  if (!since_) since_ = now;
  return now - *since_ >= delay_;
}

void MachinePlant::advance(Terminals& terminals, SteadyTime now) noexcept {
  const auto output = [&](machine::Device device) { return terminals.outputs.test(device.number); };
  const auto set_input = [&](machine::Device device, bool on) { terminals.inputs.set(device.number, on); };

  advance_spindle(terminals, now);
  set_input(machine::flood_flow_switch,
            flood_flow_.update(output(machine::flood_coolant) && !coolant_blocked_, now));
  set_input(machine::mist_flow_switch,
            mist_flow_.update(output(machine::mist_coolant) && !coolant_blocked_, now));
  set_input(machine::tool_changed_switch,
            tool_changed_.update(output(machine::tool_magazine) && output(machine::tool_clamp_release), now));
  set_input(machine::door_switch, door_closed_);
  set_input(machine::emergency_stop_chain, !emergency_stop_pressed_);
}

void MachinePlant::advance_spindle(Terminals& terminals, SteadyTime now) noexcept {
  const SpindleOrder order{terminals.outputs.test(machine::spindle_clockwise.number),
                           terminals.outputs.test(machine::spindle_counter_clockwise.number),
                           terminals.analog_outputs[0]};
  const bool was_turning = spindle_order_.clockwise || spindle_order_.counter_clockwise;
  const bool turns = order.clockwise || order.counter_clockwise;
  // A new speed means nothing to a spindle that stands.
  if (order != spindle_order_ && (was_turning || turns)) spindle_order_since_ = now;
  spindle_order_ = order;

  const bool settled = !spindle_order_since_ || now - *spindle_order_since_ >= spindle_time;
  const bool one_direction = order.clockwise != order.counter_clockwise;
  terminals.inputs.set(machine::at_speed_switch.number, settled && one_direction);
  terminals.inputs.set(machine::zero_speed_switch.number, settled && !turns);
}

}  // namespace emulator_models
