// Scan time now, shortest and longest, since the last start of RUN.
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
  std::uint64_t scans_count = 0;

  constexpr void add(std::chrono::nanoseconds scan_time) noexcept {
    now = scan_time;
    shortest = scans_count == 0 ? scan_time : std::min(shortest, scan_time);
    longest = std::max(longest, scan_time);
    ++scans_count;
  }
};

}  // namespace emulator_models::soft_plc
