#include "emulator_models/plants/machine_tool_spindle.hpp"

#include <algorithm>
#include <cmath>

#include "emulator_models/plants/machine_tool_wiring.hpp"

namespace emulator_models::machine_tool {
namespace {

/// After so many time constants the rest is below a hundredth of 1/min.
constexpr double settled_time_constants = 16;

double seconds(std::chrono::nanoseconds duration) noexcept {
  return static_cast<double>(duration.count()) * 1e-9;
}

}  // namespace

double Spindle::speed_at(SteadyTime now) const noexcept {
  const double elapsed = seconds(now - order_since_) / time_constant_;
  if (elapsed >= settled_time_constants || speed_at_order_rpm_ == target_rpm_) return target_rpm_;
  return target_rpm_ + (speed_at_order_rpm_ - target_rpm_) * std::exp(-elapsed);
}

void Spindle::advance(Terminals& terminals, bool powered, SteadyTime now) noexcept {
  const auto output = [&](Y y) { return terminals.outputs.test(index_of(y)); };
  const bool clockwise = powered && output(Y::spindle_clockwise);
  const bool counter_clockwise = powered && output(Y::spindle_counter_clockwise);
  const bool orient = powered && output(Y::spindle_orient) && !clockwise && !counter_clockwise;
  speed_rpm_ = speed_at(now);

  if (clockwise || counter_clockwise) {
    const bool other_way = clockwise ? speed_rpm_ <= -zero_speed_rpm : speed_rpm_ >= zero_speed_rpm;
    if ((clockwise && counter_clockwise) || other_way) fault_ = true;  // I2
  } else {
    fault_ = false;
  }
  const bool faulty = fault_ || drive_broken_;

  double target = 0;
  if (!faulty && clockwise != counter_clockwise) {
    target = terminals.analog_outputs[speed_order_word];
    if (counter_clockwise) target = -target;
  }
  const double time_constant = powered && !faulty ? time_constant_s : time_constant_without_power_s;
  if (target != target_rpm_ || time_constant != time_constant_) {
    target_rpm_ = target;
    time_constant_ = time_constant;
    speed_at_order_rpm_ = speed_rpm_;
    order_since_ = now;
  }

  const double magnitude = std::abs(speed_rpm_);
  const bool slow = magnitude < zero_speed_rpm;
  if (orient && !faulty && slow) {
    if (!orients_) {
      // The moment at which zero speed was reached, however late this call is; never before the order.
      const double start = std::abs(speed_at_order_rpm_);
      const double to_zero = start > zero_speed_rpm ? time_constant_ * std::log(start / zero_speed_rpm) : 0;
      const auto reached =
          order_since_ + std::chrono::nanoseconds{static_cast<std::int64_t>(std::ceil(to_zero * 1e9))};
      orientation_since_ = orientation_ordered_ ? std::clamp(reached, orientation_ordered_since_, now) : now;
    }
    orients_ = true;
  } else {
    orients_ = false;
  }
  if (orient && !orientation_ordered_) orientation_ordered_since_ = now;
  orientation_ordered_ = orient;

  const auto set_input = [&](X x, bool on) { terminals.inputs.set(index_of(x), on); };
  set_input(X::spindle_at_speed,
            !faulty && clockwise != counter_clockwise &&
                std::abs(speed_rpm_ - target_rpm_) <= at_speed_share * std::abs(target_rpm_));
  set_input(X::spindle_zero_speed, slow);
  set_input(X::spindle_drive_fault, faulty);
  set_input(X::spindle_oriented, orients_ && now - orientation_since_ >= orientation_time);
  terminals.analog_inputs[speed_actual_word] = static_cast<std::uint16_t>(std::lround(magnitude));
}

}  // namespace emulator_models::machine_tool
