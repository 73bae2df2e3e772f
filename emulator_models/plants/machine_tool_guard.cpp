#include "emulator_models/plants/machine_tool_guard.hpp"

#include "emulator_models/plants/machine_tool_wiring.hpp"

namespace emulator_models::machine_tool {

void GuardDoor::advance(Terminals& terminals, SteadyTime now) noexcept {
  if (has_run_) bolt_.run(now - last_);
  last_ = now;
  has_run_ = true;

  const bool held = bolt_.is_out() && !lock_broken_;
  if (!held) open_ = pulled_open_;
  const bool lock = !terminals.outputs.test(index_of(Y::door_unlock)) && !open_;
  bolt_.order(lock ? Travel::Order::out : Travel::Order::back);
  terminals.inputs.set(index_of(X::door_closed), !open_);
  terminals.inputs.set(index_of(X::door_locked), held && !open_);
}

bool EmergencyStop::advance(Terminals& terminals, SteadyTime now) noexcept {
  const bool closed = !button_pressed_ && !over_travel_ && !drives_not_ready_;
  const bool powered = contactor_.update(closed && terminals.outputs.test(index_of(Y::contactor)), now);
  terminals.inputs.set(index_of(X::chain_closed), closed);
  terminals.inputs.set(index_of(X::buttons_released), !button_pressed_);
  terminals.inputs.set(index_of(X::over_travel_free), !over_travel_);
  terminals.inputs.set(index_of(X::drives_ready), !drives_not_ready_);
  terminals.inputs.set(index_of(X::contactor_on), powered);
  return powered;
}

}  // namespace emulator_models::machine_tool
