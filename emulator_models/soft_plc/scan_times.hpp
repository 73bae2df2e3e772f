// Scan time now, shortest, longest and mean, since the last start of RUN.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace emulator_models::soft_plc {

/// All zero until the first scan is complete.
struct ScanTimes {
  std::chrono::nanoseconds now{0};
  std::chrono::nanoseconds shortest{0};
  std::chrono::nanoseconds longest{0};
  std::chrono::nanoseconds sum{0};
  std::uint64_t scans_count = 0;

  [[nodiscard]] constexpr std::chrono::nanoseconds mean() const noexcept {
    return scans_count == 0 ? sum : sum / static_cast<std::int64_t>(scans_count);
  }
  constexpr void add(std::chrono::nanoseconds scan_time) noexcept {
    now = scan_time;
    shortest = scans_count == 0 ? scan_time : std::min(shortest, scan_time);
    longest = std::max(longest, scan_time);
    sum += scan_time;
    ++scans_count;
  }
};

}  // namespace emulator_models::soft_plc
