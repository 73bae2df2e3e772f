// The spindle with its drive: first-order run-up to the demanded speed, braking, oriented stop.
//
// Invariants
//   I1  the speed is a function of the last order, its moment and the speed then: not of how often it was asked.
//   I2  both directions, or the other direction above zero speed, are a drive fault until all orders are off.
// At 90 % of a speed 0.7 s after the start; at zero speed (below 30 1/min) from 3000 1/min after 1.4 s. Without
// power it runs out three times as slowly.
#pragma once

#include "emulator_models/plants/terminals.hpp"
#include "emulator_models/special_devices.hpp"

namespace emulator_models::machine_tool {

class Spindle {
 public:
  static constexpr double zero_speed_rpm = 30;
  static constexpr double at_speed_share = 0.1;
  static constexpr double time_constant_s = 0.3;
  static constexpr double time_constant_without_power_s = 0.9;
  static constexpr std::chrono::milliseconds orientation_time{300};

  void advance(Terminals& terminals, bool powered, SteadyTime now) noexcept;

  void set_drive_broken(bool broken) noexcept { drive_broken_ = broken; }
  /// Signed: counter-clockwise is negative.
  [[nodiscard]] double speed_rpm() const noexcept { return speed_rpm_; }

 private:
  [[nodiscard]] double speed_at(SteadyTime now) const noexcept;

  double target_rpm_ = 0;
  double time_constant_ = time_constant_s;
  double speed_at_order_rpm_ = 0;
  SteadyTime order_since_{};
  double speed_rpm_ = 0;
  bool orients_ = false;
  SteadyTime orientation_since_{};
  bool orientation_ordered_ = false;
  SteadyTime orientation_ordered_since_{};
  bool fault_ = false;
  bool drive_broken_ = false;
};

}  // namespace emulator_models::machine_tool
