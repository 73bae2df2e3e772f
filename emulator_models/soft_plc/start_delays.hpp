// How late scans began: a histogram that takes constant time and no allocation for each scan.
//
// Ranges grow as 1, 2, 5, 10 from 10 us to 1 s; each has ten steps of equal width, so that a percentile is right to a
// tenth of it. What is later than the last range is counted in `beyond`.
// Not thread-safe.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace emulator_models::soft_plc {

class StartDelays {
 public:
  /// Upper ends of the ranges, excluded from them; the first one begins at 0.
  static constexpr std::array<std::chrono::microseconds, 16> range_ends{
      std::chrono::microseconds{10},      std::chrono::microseconds{20},
      std::chrono::microseconds{50},      std::chrono::microseconds{100},
      std::chrono::microseconds{200},     std::chrono::microseconds{500},
      std::chrono::microseconds{1'000},   std::chrono::microseconds{2'000},
      std::chrono::microseconds{5'000},   std::chrono::microseconds{10'000},
      std::chrono::microseconds{20'000},  std::chrono::microseconds{50'000},
      std::chrono::microseconds{100'000}, std::chrono::microseconds{200'000},
      std::chrono::microseconds{500'000}, std::chrono::microseconds{1'000'000}};

  /// @param delay  not negative
  void add(std::chrono::nanoseconds delay) noexcept {
    ++count_;
    longest_ = std::max(longest_, delay);
    std::size_t range = 0;
    while (range < range_ends.size() && delay >= range_ends[range]) ++range;
    if (range == range_ends.size()) {
      ++steps_.back();
    } else {
      ++steps_[range * steps_per_range +
               static_cast<std::size_t>((delay - begin_of(range)) / step_of(range))];
    }
  }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// @param range  index into range_ends
  [[nodiscard]] std::uint64_t count_in(std::size_t range) const noexcept;
  [[nodiscard]] std::uint64_t beyond() const noexcept { return steps_.back(); }
  [[nodiscard]] std::chrono::nanoseconds longest() const noexcept { return longest_; }
  /// @param permille  0 to 1000: 500 is the median
  /// @return          what that share of the scans kept to: the end of a step, at most longest(); 0 without scans
  [[nodiscard]] std::chrono::nanoseconds percentile(std::uint64_t permille) const noexcept;

 private:
  static constexpr std::size_t steps_per_range = 10;
  static constexpr std::chrono::nanoseconds begin_of(std::size_t range) noexcept {
    return range == 0 ? std::chrono::nanoseconds{0} : std::chrono::nanoseconds{range_ends[range - 1]};
  }
  static constexpr std::chrono::nanoseconds step_of(std::size_t range) noexcept {
    return (range_ends[range] - begin_of(range)) / steps_per_range;
  }

  static constexpr std::size_t steps_count = range_ends.size() * steps_per_range;

  std::array<std::uint64_t, steps_count + 1> steps_{};  ///< the last one: beyond
  std::uint64_t count_ = 0;
  std::chrono::nanoseconds longest_{0};
};

}  // namespace emulator_models::soft_plc
