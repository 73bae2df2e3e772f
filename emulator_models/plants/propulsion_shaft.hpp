// Engine and shaft: a speed that follows the torque order with a first-order lag, slowed by the sea.
//
//   speed' = (torque * (1 - load) - speed) / 4 s        in 0.1 % of rated speed, ahead positive
//
// Not enabled, the torque is nothing and the shaft runs down by the same law. The order is limited to +-100 %
// by the drive. One implicit step a call: it cannot overshoot, however long the step.
// Left out: a gear, the propeller's quadratic law, a stop by brake.
#pragma once

#include <chrono>
#include <cstdint>

namespace emulator_models::propulsion {

class PropulsionShaft {
 public:
  static constexpr std::chrono::nanoseconds time_constant = std::chrono::seconds{4};
  static constexpr std::int32_t calm_sea_load_permille = 100;
  /// What a speed sensor without supply shows.
  static constexpr std::uint16_t broken_sensor_word = 0x7FFF;

  void pass(std::chrono::nanoseconds elapsed) noexcept;
  /// @param torque_word  0.1 %, two's complement
  void order(bool enabled, std::uint16_t torque_word) noexcept;

  [[nodiscard]] std::int32_t speed_permille() const noexcept;
  [[nodiscard]] std::uint16_t speed_word() const noexcept;

  /// @param permille  part of the torque that the sea takes, 0 to 900; beyond is the nearer end
  void set_sea_load(std::int32_t permille) noexcept;
  /// Stands at once, whatever is ordered.
  void set_blocked(bool on) noexcept { blocked_ = on; }
  void set_sensor_broken(bool on) noexcept { sensor_broken_ = on; }

 private:
  double speed_permille_ = 0;
  double torque_permille_ = 0;
  double load_ = calm_sea_load_permille / 1000.0;
  bool blocked_ = false;
  bool sensor_broken_ = false;
};

}  // namespace emulator_models::propulsion
