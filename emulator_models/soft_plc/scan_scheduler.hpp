// Several cycles on one processor: which of them does the next step. Pseudo-multithreading, without threads: one
// step of one cycle at a time, and after each step (a phase, or one slice of the program) it is decided anew.
//
//   1  a cycle that has to enter a fault
//   2  of the priorities that have something to do and whose timer has ticked, the highest
//   3  if none has ticked, the one whose timer ticks next: the processor never idles while there is work
//   within a priority, the cycle that has waited longest since its last step, or since its scan was due
//
// A slice uses up the tick of its priority. So a short interval means slices more often; interval 0 ticks always:
// priorities of interval 0 let nothing below them pass while they have work.
//
// Invariants
//   I1  a cycle that has something to do is named whenever no other has: none is forgotten.
//   I2  cycles of equal priority that all have work get steps in turn.
//   I3  a fault in one cycle takes all others to other_cycle before any of them does another step.
//   I4  a cycle whose watchdog's limit has passed while others ran is the next one, whatever its priority.
//
// Not thread-safe.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/scan_task.hpp"

namespace emulator_models::soft_plc {

struct CycleConfig {
  ScanConfig scan{};
  std::size_t priority{0};  ///< 0 is the highest; index into slice_intervals
};

struct SchedulerConfig {
  std::vector<CycleConfig> cycles;
  /// Of the timer of each priority; not negative.
  std::vector<std::chrono::nanoseconds> slice_intervals;
};

enum class SchedulerConfigError : std::uint8_t {
  cycle_refused,
  priority_unknown,
  slice_interval_out_of_range,
};
/// @return what is wrong and what is allowed
[[nodiscard]] std::string_view to_string(SchedulerConfigError error) noexcept;

class ScanScheduler {
 public:
  struct Slice {
    std::optional<std::size_t> cycle;  ///< index into the configuration; none: all cycles wait
    ScanStep step;                     ///< if all wait: wait, until the first of them is due
  };

  /// cycle_refused: ScanTask::make tells why.
  [[nodiscard]] static tl::expected<ScanScheduler, SchedulerConfigError> make(const SchedulerConfig& config,
                                                                              std::chrono::nanoseconds now);

  /// @param now   as for ScanTask::next
  /// @param last  how the step of the slice before has ended
  [[nodiscard]] Slice next(std::chrono::nanoseconds now, Progress last = Progress::finished) noexcept;

  /// For orders and for what is to be shown.
  /// @param index  below the number of cycles
  [[nodiscard]] ScanTask& cycle(std::size_t index) noexcept { return cycles_[index].task; }
  [[nodiscard]] const ScanTask& cycle(std::size_t index) const noexcept { return cycles_[index].task; }

 private:
  struct Cycle {
    ScanTask task;
    std::size_t priority;
    Progress last = Progress::finished;
    bool in_scan = false;
    std::chrono::nanoseconds last_served{0};
    std::uint64_t last_slice_number = 0;  ///< tells who waits longer when steps take no time

    [[nodiscard]] std::chrono::nanoseconds waiting_since() const noexcept;
    [[nodiscard]] bool waits_longer_than(const Cycle& other) const noexcept;
  };
  struct Timer {
    std::chrono::nanoseconds interval;
    std::chrono::nanoseconds tick;
  };

  ScanScheduler() = default;
  /// @return index of the cycle that is to go on; none if all wait
  [[nodiscard]] std::optional<std::size_t> choose(std::chrono::nanoseconds now) const noexcept;
  [[nodiscard]] bool goes_before(const Cycle& a, const Cycle& b, std::chrono::nanoseconds now) const noexcept;
  void use_tick(Timer& timer, std::chrono::nanoseconds now) noexcept;
  void halt_others(std::size_t index) noexcept;

  std::vector<Cycle> cycles_;
  std::vector<Timer> timers_;
  std::optional<std::size_t> running_;
  std::uint64_t slices_count_ = 0;
};

}  // namespace emulator_models::soft_plc
