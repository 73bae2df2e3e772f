#include "emulator_models/plants/machine_tool_fluids.hpp"

#include "emulator_models/plants/machine_tool_wiring.hpp"

namespace emulator_models::machine_tool {
namespace {

bool is_on(const Terminals& terminals, Y output) noexcept { return terminals.outputs.test(index_of(output)); }
void set(Terminals& terminals, X input, bool on) noexcept { terminals.inputs.set(index_of(input), on); }

}  // namespace

void Coolant::advance(Terminals& terminals, bool powered, SteadyTime now) noexcept {
  const bool flood = powered && is_on(terminals, Y::flood_pump) && !motor_overload_;
  const bool mist = powered && is_on(terminals, Y::mist_valve);
  flood_flows_ = flood_.update(flood && !flood_blocked_, now);
  mist_flows_ = mist_.update(mist && !mist_blocked_, now);
  set(terminals, X::flood_flow, flood_flows_);
  set(terminals, X::mist_flow, mist_flows_);
  set(terminals, X::coolant_level_low, level_low_);
  set(terminals, X::coolant_motor_overload, motor_overload_);
}

void Hydraulics::advance(Terminals& terminals, bool powered, SteadyTime now) noexcept {
  if (has_run_) chuck_.run(now - last_);
  last_ = now;
  has_run_ = true;

  const bool pump = powered && is_on(terminals, Y::hydraulic_pump) && !motor_overload_ && !pressure_missing_;
  const bool pressure = pressure_.update(pump, now);
  const bool clamp = is_on(terminals, Y::chuck_clamp);
  const bool unclamp = is_on(terminals, Y::chuck_unclamp);
  Travel::Order order = Travel::Order::hold;
  if (pressure && clamp != unclamp && !chuck_stuck_)
    order = unclamp ? Travel::Order::out : Travel::Order::back;
  chuck_.order(order);

  set(terminals, X::hydraulic_pressure, pressure);
  set(terminals, X::chuck_clamped, chuck_.is_back());
  set(terminals, X::chuck_unclamped, chuck_.is_out());
  set(terminals, X::hydraulic_motor_overload, motor_overload_);
}

void Lubrication::advance(Terminals& terminals, bool powered, SteadyTime now) noexcept {
  const bool pump = powered && is_on(terminals, Y::lubrication_pump) && !pressure_missing_;
  set(terminals, X::lubrication_pressure, pressure_.update(pump, now));
  set(terminals, X::lubrication_level_low, level_low_);
}

}  // namespace emulator_models::machine_tool
