#include "emulator_models/plants/lubricating_oil.hpp"

#include <algorithm>

namespace emulator_models::propulsion {

void LubricatingOil::pass(std::chrono::nanoseconds elapsed) noexcept {
  using std::chrono::nanoseconds;
  bool delivered = false;
  for (std::size_t i = 0; i < pumps_count; ++i) delivered |= runs(i) && !pumps_[i].without_pressure;
  // A step longer than both times changes nothing more; held so, the product below cannot overflow.
  const nanoseconds step = std::min(elapsed, build_up_time);
  if (delivered) {
    pressure_ = std::min(pressure_ + step, build_up_time);
  } else {
    pressure_ = std::max(pressure_ - step * (build_up_time / fall_time), nanoseconds{0});
  }
  if (pressure_ == build_up_time) has_pressure_ = true;
  if (pressure_ < build_up_time / 2) has_pressure_ = false;
}

bool LubricatingOil::pressure_switch_closed() const noexcept {
  if (stuck_open_) return false;
  return stuck_closed_ || has_pressure_;
}

}  // namespace emulator_models::propulsion
