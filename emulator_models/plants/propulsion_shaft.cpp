#include "emulator_models/plants/propulsion_shaft.hpp"

#include <algorithm>

namespace emulator_models::propulsion {

void PropulsionShaft::pass(std::chrono::nanoseconds elapsed) noexcept {
  if (blocked_) {
    speed_permille_ = 0;
    return;
  }
  const auto step = static_cast<double>(elapsed.count());
  const double part = step / (static_cast<double>(time_constant.count()) + step);
  speed_permille_ += (torque_permille_ * (1 - load_) - speed_permille_) * part;
}

void PropulsionShaft::order(bool enabled, std::uint16_t torque_word) noexcept {
  const int torque = std::clamp<int>(static_cast<std::int16_t>(torque_word), -1000, 1000);
  torque_permille_ = enabled ? torque : 0;
}

std::int32_t PropulsionShaft::speed_permille() const noexcept {
  return static_cast<std::int32_t>(speed_permille_ + (speed_permille_ < 0 ? -0.5 : 0.5));
}

std::uint16_t PropulsionShaft::speed_word() const noexcept {
  return sensor_broken_ ? broken_sensor_word : static_cast<std::uint16_t>(speed_permille());
}

void PropulsionShaft::set_sea_load(std::int32_t permille) noexcept {
  load_ = std::clamp(permille, 0, 900) / 1000.0;
}

}  // namespace emulator_models::propulsion
