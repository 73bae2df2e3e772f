// One cycle of a soft PLC: what it has to do next, as a function of the time and of what was ordered.
//
//   RUN   system analysis, read inputs, read from cycles, execute, write to cycles, write outputs, wait
//   STOP  system analysis, read inputs, refresh output image, wait
//
// without the two exchanges for the classic cycle. The task never acts and has no clock: next() returns a step,
// the caller carries it out (perform(), scan_program.hpp) and asks again.
//
// Invariants
//   I1  each scan runs in one mode, set at the end of its system analysis (and of clear_fault, if that follows):
//       an order of RUN or STOP in mid scan counts from the next scan on.
//   I2  each RUN after a STOP begins with an initialisation and one first scan, even if both orders came
//       between two analyses.
//   I3  when a scan of RUN has lasted longer than the watchdog allows, the next step is enter_fault; a scan that
//       lasts as long as allowed is normal.
//   I4  after a fault, until reset and then RUN are ordered, no step is execute or write_outputs.
//   I5  a scan that is given up writes neither outputs nor values for other cycles after that.
//
// The reasons, and what else is left open by the sources: scan_engine.md. Not thread-safe.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/scan_period.hpp"
#include "emulator_models/soft_plc/scan_program.hpp"
#include "emulator_models/soft_plc/scan_times.hpp"
#include "emulator_models/soft_plc/watchdog.hpp"

namespace emulator_models::soft_plc {

enum class RunMode : std::uint8_t { stop, run };

/// What becomes of the outputs on the change from RUN to STOP by order; a fault always makes them safe.
enum class OutputsInStop : std::uint8_t { safe, hold };

struct ScanConfig {
  static constexpr std::chrono::hours duration_max{1};

  std::chrono::nanoseconds period{0};  ///< 0: the next scan follows at once; at most duration_max
  OverrunRule overrun = OverrunRule::skip;
  std::chrono::nanoseconds watchdog_limit = Watchdog::limit_default;  ///< above 0, at most duration_max
  bool exchanges_with_cycles = true;                                  ///< false: the classic four phases
  OutputsInStop outputs_in_stop = OutputsInStop::safe;
};

enum class ScanConfigError : std::uint8_t { period_out_of_range, watchdog_limit_out_of_range };
/// @return what is wrong and what is allowed
[[nodiscard]] std::string_view to_string(ScanConfigError error) noexcept;

/// Error codes; the numbers are stable.
enum class FaultCode : std::uint16_t {
  watchdog = 1,        ///< a scan lasted longer than the limit
  overrun = 2,         ///< OverrunRule::stop, and a start could not be kept
  program_failed = 3,  ///< a run-time fault in the program
  other_cycle = 4,     ///< another cycle of the same PLC has a fault
  io_failed = 5,       ///< inputs are stale, and the driver's configuration makes that a fault
};

struct Fault {
  FaultCode code = FaultCode::watchdog;
  ScanAction action = ScanAction::wait;   ///< the last step before
  std::uint64_t scan_number = 0;          ///< 1 = the first scan since power-up, RUN or STOP
  std::chrono::nanoseconds scan_time{0};  ///< from the start of that scan to the fault

  friend bool operator==(const Fault&, const Fault&) = default;
};

class ScanTask {
 public:
  /// In STOP, without a fault; the first scan is due at once.
  [[nodiscard]] static tl::expected<ScanTask, ScanConfigError> make(const ScanConfig& config,
                                                                    std::chrono::nanoseconds now) noexcept;

  /// @param now   one that is earlier than in the call before counts as equal to it
  /// @param last  how the step before has ended; of no meaning after wait
  /// @return      what to do now
  [[nodiscard]] ScanStep next(std::chrono::nanoseconds now, Progress last = Progress::finished) noexcept;

  /// To RUN; without effect on a cycle that is there and has not been stopped meanwhile.
  /// @param start  that of the latest order counts
  /// @return false = refused: there is a fault, which has to be reset first
  [[nodiscard]] bool order_run(StartKind start) noexcept;
  void order_stop() noexcept;
  /// Clears a fault at the next system analysis. The mode stays STOP.
  void order_reset() noexcept;
  /// A PLC that reads the watchdog's limit from its memory calls this in the system analysis of each scan.
  /// @param limit  above zero
  void set_watchdog_limit(std::chrono::nanoseconds limit) noexcept { watchdog_.set_limit(limit); }
  /// A fault that comes from outside the cycle: enter_fault is the next step, in a wait and in STOP, too. A
  /// fault that is there already stays, and what was ordered to end it is void.
  void halt(FaultCode code) noexcept;
  /// Period, overrun rule and watchdog's limit of the next scan on; the grid goes on from its next point, the
  /// counts are kept. All else stays as it was made.
  /// @param config  one that make() takes
  void reconfigure(const ScanConfig& config) noexcept { next_config_ = config; }

  [[nodiscard]] RunMode mode() const noexcept { return mode_; }
  [[nodiscard]] const std::optional<Fault>& fault() const noexcept { return fault_; }
  /// Of whole scans in RUN: from the start of system analysis to the end of write outputs.
  [[nodiscard]] const ScanTimes& scan_times() const noexcept { return scan_times_; }
  [[nodiscard]] const ScanPeriod& period() const noexcept { return period_; }
  /// Of the scan under way, else of the latest; 0 before the first since power-up.
  [[nodiscard]] std::uint64_t scan_number() const noexcept { return scan_number_; }
  /// Whether a step of a scan was the latest one.
  [[nodiscard]] bool is_in_scan() const noexcept { return action_ != ScanAction::wait; }
  /// Whether next(now) has something to say but wait: the end of a scan, or a step.
  [[nodiscard]] bool is_ready(std::chrono::nanoseconds now) const noexcept;
  /// Whether it would be enter_fault, because of halt() or of the watchdog.
  [[nodiscard]] bool is_urgent(std::chrono::nanoseconds now) const noexcept;

 private:
  ScanTask(const ScanConfig& config, std::chrono::nanoseconds now) noexcept;

  [[nodiscard]] bool watchdog_bites(std::chrono::nanoseconds now) const noexcept;
  [[nodiscard]] ScanStep step(ScanAction action) noexcept;
  [[nodiscard]] ScanStep enter_fault(FaultCode code) noexcept;
  [[nodiscard]] ScanStep begin_scan() noexcept;
  [[nodiscard]] ScanStep change_mode() noexcept;
  [[nodiscard]] ScanStep after(ScanAction finished) noexcept;
  [[nodiscard]] ScanStep end_scan() noexcept;

  ScanConfig config_;
  std::optional<ScanConfig> next_config_;
  ScanPeriod period_;
  Watchdog watchdog_;
  ScanTimes scan_times_;
  std::chrono::nanoseconds now_;
  std::chrono::nanoseconds scan_start_;
  std::uint64_t scan_number_ = 0;
  ScanAction action_ = ScanAction::wait;

  RunMode mode_ = RunMode::stop;
  RunMode ordered_mode_ = RunMode::stop;
  StartKind ordered_start_ = StartKind::cold;
  StartKind start_ = StartKind::cold;
  bool stop_was_ordered_ = false;
  bool reset_was_ordered_ = false;
  bool scan_is_open_ = false;
  bool first_scan_ = false;
  std::optional<FaultCode> halt_code_;
  std::optional<Fault> fault_;
};

}  // namespace emulator_models::soft_plc
