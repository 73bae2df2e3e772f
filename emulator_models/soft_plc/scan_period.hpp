// When the next scan of a cycle is due, and what becomes of starts that could not be kept.
//
// Starts lie on a grid: first start + n x period. A scan that ends on the next point of the grid is in time; one
// that ends later has overrun:
//
//   stop      the caller is told, and makes it a fault; the grid goes on as with skip
//   skip      the next start is the next point of the grid that has not passed, those between are lost
//   catch_up  the scans that are behind follow one another at once, until the grid is reached again; beyond
//             catch_up_max they are lost
//
// Invariants
//   I1  at most floor(w / period) + 1 due moments lie in any span of length w.
//   I2  with stop and skip a scan is never due before the one before has ended.
//   I3  each point of the grid has one start or is counted as lost.
//
// A start that the host delays keeps its point of the grid: the next scan can begin sooner than a period later.
// Period 0: no grid, a scan is due as soon as the one before has ended, and nothing overruns.
#pragma once

#include <chrono>
#include <cstdint>

namespace emulator_models::soft_plc {

enum class OverrunRule : std::uint8_t { stop, skip, catch_up };

class ScanPeriod {
 public:
  /// An hour's sleep of the host must not become an hour of scans without a pause.
  static constexpr std::int64_t catch_up_max = 100;

  /// @param period       not negative
  /// @param first_start  the first point of the grid
  ScanPeriod(std::chrono::nanoseconds period, OverrunRule rule,
             std::chrono::nanoseconds first_start) noexcept;

  [[nodiscard]] std::chrono::nanoseconds due() const noexcept { return due_; }

  /// A scan starts.
  /// @param now  not before due()
  /// @return     whether starts were lost because it starts so late
  [[nodiscard]] bool begin_scan(std::chrono::nanoseconds now) noexcept;

  /// The scan has ended; due() moves on.
  /// @param now  not before the start
  /// @return     whether the scan has overrun
  [[nodiscard]] bool end_scan(std::chrono::nanoseconds now) noexcept;

  /// The grid goes on from the scan that began last.
  void change(std::chrono::nanoseconds period, OverrunRule rule) noexcept {
    period_ = period;
    rule_ = rule;
  }

  [[nodiscard]] std::uint64_t overruns_count() const noexcept { return overruns_count_; }
  [[nodiscard]] std::uint64_t lost_starts_count() const noexcept { return lost_starts_count_; }
  /// How late the latest scan started: since it was due, starts that were lost over that included.
  [[nodiscard]] std::chrono::nanoseconds start_delay() const noexcept { return start_delay_; }

 private:
  void lose_starts(std::int64_t count) noexcept;

  std::chrono::nanoseconds period_;
  OverrunRule rule_;
  std::chrono::nanoseconds due_;
  std::chrono::nanoseconds start_delay_{0};
  std::uint64_t overruns_count_ = 0;
  std::uint64_t lost_starts_count_ = 0;
};

}  // namespace emulator_models::soft_plc
