// The two ways in which most units of a plant follow their orders: something travels between two end positions,
// and something is on a time after its order. Both know the moment of each order, so that what they report at a
// time does not depend on how often they were asked before.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "emulator_models/special_devices.hpp"

namespace emulator_models {

/// Travels between 0 (at rest) and its whole way in a fixed time, either way.
class Travel {
 public:
  enum class Order : std::uint8_t { hold, out, back };

  explicit Travel(std::chrono::nanoseconds whole_time) noexcept : whole_{whole_time} {}

  /// Moves on under the order given last.
  /// @param elapsed  not negative
  void run(std::chrono::nanoseconds elapsed) noexcept {
    if (order_ == Order::out) at_ = std::min(whole_, at_ + elapsed);
    if (order_ == Order::back) at_ = std::max(std::chrono::nanoseconds{0}, at_ - elapsed);
  }
  void order(Order order) noexcept { order_ = order; }

  [[nodiscard]] bool is_out() const noexcept { return at_ == whole_; }
  [[nodiscard]] bool is_back() const noexcept { return at_.count() == 0; }
  [[nodiscard]] bool moves() const noexcept {
    return (order_ == Order::out && !is_out()) || (order_ == Order::back && !is_back());
  }
  /// At once, by hand.
  void put_back() noexcept { at_ = std::chrono::nanoseconds{0}; }
  void put_out() noexcept { at_ = whole_; }

 private:
  std::chrono::nanoseconds whole_;
  std::chrono::nanoseconds at_{0};
  Order order_ = Order::hold;
};

/// On once its condition has held for a time, off with it.
class OnDelay {
 public:
  explicit OnDelay(std::chrono::nanoseconds delay) noexcept : delay_{delay} {}

  bool update(bool condition, SteadyTime now) noexcept {
    if (!condition) {
      holds_ = false;
      return false;
    }
    if (!holds_) since_ = now;
    holds_ = true;
    return now - since_ >= delay_;
  }

 private:
  std::chrono::nanoseconds delay_;
  SteadyTime since_{};
  bool holds_ = false;
};

}  // namespace emulator_models
