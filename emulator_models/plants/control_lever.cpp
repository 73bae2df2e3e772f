#include "emulator_models/plants/control_lever.hpp"

#include <algorithm>

namespace emulator_models::propulsion {
namespace {

constexpr std::int64_t ns_per_permille = ControlLever::servo_travel_time.count() / 2000;
constexpr std::int64_t end_ns = 1000 * ns_per_permille;
constexpr std::int64_t middle_word = 1200;
constexpr std::int64_t half_range_word = 800;
constexpr std::int64_t noise_word = 10;

bool closed(ControlLever::Switch state, bool sound) noexcept {
  return state == ControlLever::Switch::sound ? sound : state == ControlLever::Switch::stuck_closed;
}

}  // namespace

void ControlLever::pass(std::chrono::nanoseconds elapsed) noexcept {
  noise_is_high_ = !noise_is_high_;
  if (!servo_on_ || servo_jammed_) return;
  const std::int64_t step = std::min(elapsed, servo_travel_time).count();
  position_ns_ += std::clamp(ordered_ns_ - position_ns_, -step, step);
}

void ControlLever::order_servo(bool on, std::uint16_t word) noexcept {
  servo_on_ = on;
  const std::int64_t held =
      std::clamp<std::int64_t>(word, middle_word - half_range_word, middle_word + half_range_word);
  ordered_ns_ = (held - middle_word) * end_ns / half_range_word;
}

void ControlLever::move_to(std::int32_t permille) noexcept {
  if (!servo_on_) position_ns_ = std::clamp<std::int64_t>(permille, -1000, 1000) * ns_per_permille;
}

std::int32_t ControlLever::position_permille() const noexcept {
  return static_cast<std::int32_t>(position_ns_ / ns_per_permille);
}

std::uint16_t ControlLever::word() const noexcept {
  if (wire_broken_) return broken_wire_word;
  if (short_circuit_) return short_circuit_word;
  const std::int64_t noise = noisy_ ? (noise_is_high_ ? noise_word : -noise_word) : 0;
  return static_cast<std::uint16_t>(middle_word + position_ns_ * half_range_word / end_ns + noise);
}

bool ControlLever::astern_closed() const noexcept {
  return closed(astern_, position_ns_ < -switch_point_permille * ns_per_permille);
}

bool ControlLever::stop_closed() const noexcept {
  return closed(stop_, position_ns_ >= -switch_point_permille * ns_per_permille &&
                           position_ns_ <= switch_point_permille * ns_per_permille);
}

bool ControlLever::ahead_closed() const noexcept {
  return closed(ahead_, position_ns_ > switch_point_permille * ns_per_permille);
}

}  // namespace emulator_models::propulsion
