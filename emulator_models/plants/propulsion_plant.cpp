#include "emulator_models/plants/propulsion_plant.hpp"

#include <algorithm>

#include "emulator_models/plants/propulsion_devices.hpp"

namespace emulator_models {

using propulsion::ControlLever;

void PropulsionPlant::advance(Terminals& terminals, SteadyTime now) noexcept {
  const SteadyTime last = last_.value_or(now);
  const std::chrono::nanoseconds elapsed = std::max(now, last) - last;
  last_ = last + elapsed;
  oil_.pass(elapsed);
  lever_.pass(elapsed);
  shaft_.pass(elapsed);

  const auto output = [&](propulsion::Device device) { return terminals.outputs.test(device.number); };
  oil_.order(0, output(propulsion::pump_1));
  oil_.order(1, output(propulsion::pump_2));
  lever_.order_servo(output(propulsion::lever_servo),
                     terminals.analog_outputs[propulsion::lever_order_output]);
  shaft_.order(output(propulsion::run), terminals.analog_outputs[propulsion::torque_output]);
  set_inputs(terminals);
}

void PropulsionPlant::set_inputs(Terminals& terminals) const noexcept {
  const auto set = [&](propulsion::Device device, bool on) { terminals.inputs.set(device.number, on); };
  set(propulsion::lever_astern, lever_.astern_closed());
  set(propulsion::lever_stop, lever_.stop_closed());
  set(propulsion::lever_ahead, lever_.ahead_closed());
  set(propulsion::oil_pressure, oil_.pressure_switch_closed());
  set(propulsion::pump_1_runs, oil_.runs(0));
  set(propulsion::pump_2_runs, oil_.runs(1));
  set(propulsion::pump_1_protection, oil_.protection_closed(0));
  set(propulsion::pump_2_protection, oil_.protection_closed(1));
  set(propulsion::acknowledge_button, hands_.acknowledge);
  set(propulsion::local_switch, hands_.local);
  set(propulsion::start_button, hands_.start);
  set(propulsion::stop_button, !hands_.stop);
  set(propulsion::pumps_switch, hands_.pumps);
  terminals.analog_inputs[propulsion::lever_input] = lever_.word();
  terminals.analog_inputs[propulsion::speed_input] = shaft_.speed_word();
}

void PropulsionPlant::set_failure(PropulsionFailure failure, bool on) noexcept {
  using enum PropulsionFailure;
  const auto stuck = [on](ControlLever::Switch state) { return on ? state : ControlLever::Switch::sound; };
  switch (failure) {
    case pump_1_without_pressure:
      return oil_.set_without_pressure(0, on);
    case pump_2_without_pressure:
      return oil_.set_without_pressure(1, on);
    case pump_1_overload:
      return oil_.set_overloaded(0, on);
    case pump_2_overload:
      return oil_.set_overloaded(1, on);
    case pressure_switch_stuck_closed:
      return oil_.set_switch_stuck_closed(on);
    case pressure_switch_stuck_open:
      return oil_.set_switch_stuck_open(on);
    case lever_wire_broken:
      return lever_.set_wire_broken(on);
    case lever_short_circuit:
      return lever_.set_short_circuit(on);
    case lever_noise:
      return lever_.set_noisy(on);
    case lever_servo_jammed:
      return lever_.set_servo_jammed(on);
    case astern_switch_stuck_open:
      return lever_.set_astern_switch(stuck(ControlLever::Switch::stuck_open));
    case stop_switch_stuck_closed:
      return lever_.set_stop_switch(stuck(ControlLever::Switch::stuck_closed));
    case ahead_switch_stuck_open:
      return lever_.set_ahead_switch(stuck(ControlLever::Switch::stuck_open));
    case shaft_blocked:
      return shaft_.set_blocked(on);
    case speed_sensor_broken:
      return shaft_.set_sensor_broken(on);
  }
}

}  // namespace emulator_models
