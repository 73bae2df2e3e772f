// What a cycle does, as event records: looks at the scan task after each of its steps and pushes what has changed.
//
// Scans are summed up, one record for each span of time, so that a day at 1 ms is 86 400 records and not 86 million.
// A span ends early when the mode changes or a fault comes: what led to it stands before it. Each overrun has a record
// of its own, up to overruns_per_span; beyond that only the sum counts them, else a cycle that always overruns would
// push out of the archive what led there.
//
// Invariants
//   I1  a call takes constant time and pushes at most records_per_step_max records.
//   I2  the counts of all `scans` records, those lost in the ring included, add up to the scans of RUN.
// The thread of the cycle only.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "emulator_models/soft_plc/event_ring.hpp"
#include "emulator_models/soft_plc/il_error.hpp"
#include "emulator_models/soft_plc/scan_task.hpp"

namespace emulator_models::soft_plc {

class CycleRecorder {
 public:
  static constexpr std::chrono::seconds span{1};
  static constexpr std::uint64_t overruns_per_span = 10;
  static constexpr int records_per_step_max = 5;

  /// @param ring   outlives the recorder
  /// @param cycle  its number in all records
  CycleRecorder(EventRing& ring, std::uint8_t cycle, std::chrono::nanoseconds power_up) noexcept;

  /// After each ScanTask::next(), with its time.
  void observe(const ScanTask& task, std::uint64_t scan_number, std::chrono::nanoseconds now) noexcept;
  /// Where the program failed; belongs to the fault program_failed that observe() sees next.
  void program_failed_at(SourcePlace place) noexcept { failed_at_ = place; }
  /// Pushes what has been summed up so far, before the cycle ends.
  void finish(std::chrono::nanoseconds now) noexcept;

 private:
  [[nodiscard]] EventRecord record(EventKind kind, std::chrono::nanoseconds now) const noexcept;
  void observe_scan_end(const ScanTask& task, std::chrono::nanoseconds now) noexcept;
  void observe_fault(const std::optional<Fault>& fault, std::chrono::nanoseconds now) noexcept;

  EventRing& ring_;
  std::uint8_t cycle_;
  std::chrono::nanoseconds power_up_;
  std::uint64_t scan_number_ = 0;

  std::uint64_t scans_seen_ = 0;
  std::uint64_t overruns_seen_ = 0;
  RunMode mode_ = RunMode::stop;
  std::optional<Fault> fault_;
  SourcePlace failed_at_{0, 0};

  std::chrono::nanoseconds span_end_;
  ScanTimes times_;  ///< of this span
  std::chrono::nanoseconds times_sum_{0};
  std::uint64_t overruns_ = 0;
};

}  // namespace emulator_models::soft_plc
