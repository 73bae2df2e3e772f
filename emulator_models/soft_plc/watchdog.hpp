// Watches one scan: a scan that lasts as long as the limit is still normal, one that lasts longer is not.
//
// Only the start of the next scan begins the watch anew: there is no way to buy time within a scan. The caller brings the
// time, and decides what a bite means (scan_task.hpp).
#pragma once

#include <chrono>

namespace emulator_models::soft_plc {

class Watchdog {
 public:
  static constexpr std::chrono::milliseconds limit_default{150};

  /// @param limit  above zero
  explicit constexpr Watchdog(std::chrono::nanoseconds limit = limit_default) noexcept : limit_{limit} {}

  constexpr void begin_scan(std::chrono::nanoseconds now) noexcept { scan_start_ = now; }

  /// Holds from now on, for the scan that is under way, too.
  constexpr void set_limit(std::chrono::nanoseconds limit) noexcept { limit_ = limit; }

  /// @return whether the scan that began last has lasted too long, if it still is under way
  [[nodiscard]] constexpr bool bites(std::chrono::nanoseconds now) const noexcept {
    return now - scan_start_ > limit_;
  }

  /// The last moment at which the scan that is under way is still normal.
  [[nodiscard]] constexpr std::chrono::nanoseconds deadline() const noexcept { return scan_start_ + limit_; }

 private:
  std::chrono::nanoseconds limit_;
  std::chrono::nanoseconds scan_start_{0};
};

}  // namespace emulator_models::soft_plc
