#include "emulator_models/plants/machine_tool_changer.hpp"

#include <utility>

#include "emulator_models/plants/machine_tool_wiring.hpp"

namespace emulator_models::machine_tool {
namespace {

using std::chrono::nanoseconds;

constexpr nanoseconds turn_time = ToolChanger::pocket_time * ToolChanger::pockets_count;

}  // namespace

ToolChanger::ToolChanger() noexcept {
  for (std::size_t i = 0; i < tools_.size(); ++i) tools_[i] = static_cast<std::uint16_t>(i + 1);
}

std::size_t ToolChanger::pocket_at_change() const noexcept {
  const nanoseconds rounded = position_ + nanoseconds{pocket_time} / 2;
  return static_cast<std::size_t>(rounded / pocket_time) % pockets_count + 1;
}

bool ToolChanger::pocket_stands() const noexcept {
  const nanoseconds past = position_ % pocket_time;
  return past <= pulse_half || past >= nanoseconds{pocket_time} - pulse_half;
}

void ToolChanger::advance(Terminals& terminals, bool powered, SteadyTime now) noexcept {
  if (has_run_) run(now - last_);
  last_ = now;
  has_run_ = true;
  take_orders(terminals, powered);

  const auto set_input = [&](X x, bool on) { terminals.inputs.set(index_of(x), on); };
  const bool stands = pocket_stands();
  set_input(X::pocket_pulse, stands && !pulse_lost_);
  set_input(X::magazine_home, stands && pocket_at_change() == 1);
  set_input(X::pocket_is_down, pocket_.is_out());
  set_input(X::pocket_is_up, pocket_.is_back());
  set_input(X::arm_home, grip_.is_back());
  set_input(X::arm_gripping, grip_.is_out());
  set_input(X::arm_exchanged, exchange_.is_out());
  set_input(X::tool_clamped, clamp_.is_back());
  set_input(X::tool_unclamped, clamp_.is_out());
  set_input(X::tool_present, tool_in_spindle_ != 0);
  set_input(X::magazine_motor_overload, magazine_overload_ || jammed_ || both_ways_);
}

void ToolChanger::run(nanoseconds elapsed) noexcept {
  if (magazine_direction_ != 0) {
    position_ = (position_ + magazine_direction_ * elapsed) % turn_time;
    if (position_ < nanoseconds{0}) position_ += turn_time;
  }
  pocket_.run(elapsed);
  grip_.run(elapsed);
  exchange_.run(elapsed);
  clamp_.run(elapsed);
  if (exchange_.is_out() && !exchanged_) {
    exchanged_ = true;
    std::swap(tool_in_spindle_, tools_[pocket_at_change() - 1]);
  }
}

void ToolChanger::take_orders(const Terminals& terminals, bool powered) noexcept {
  const auto output = [&](Y y) { return terminals.outputs.test(index_of(y)); };
  const auto travel = [&](bool out, bool stuck) {
    if (!powered || stuck) return Travel::Order::hold;
    return out ? Travel::Order::out : Travel::Order::back;
  };
  const bool clockwise = powered && output(Y::magazine_clockwise);
  const bool counter_clockwise = powered && output(Y::magazine_counter_clockwise);
  both_ways_ = clockwise && counter_clockwise;
  magazine_direction_ = 0;
  if (clockwise != counter_clockwise && !magazine_overload_ && !magazine_stuck_) {
    magazine_direction_ = clockwise ? 1 : -1;
  }

  pocket_.order(travel(output(Y::pocket_down), pocket_stuck_));
  grip_.order(travel(output(Y::arm_grip), arm_stuck_));
  if (clamp_stuck_) {
    clamp_.order(Travel::Order::hold);
  } else {
    clamp_.order(powered && output(Y::tool_unclamp) ? Travel::Order::out : Travel::Order::back);
  }

  const bool exchange = output(Y::arm_exchange);
  if (!exchange) {
    jammed_ = false;
    exchanged_ = false;
    exchange_.put_back();
  } else if (powered && exchange_.is_back() &&
             !(grip_.is_out() && pocket_.is_out() && clamp_.is_out() && magazine_direction_ == 0)) {
    jammed_ = true;  // I1
  }
  exchange_.order(exchange && powered && !jammed_ && !arm_stuck_ ? Travel::Order::out : Travel::Order::hold);
}

}  // namespace emulator_models::machine_tool
