#include "emulator_models/soft_plc/cycle_recorder.hpp"

#include <utility>

namespace emulator_models::soft_plc {

using std::chrono::nanoseconds;

CycleRecorder::CycleRecorder(EventRing& ring, std::uint8_t cycle, nanoseconds power_up) noexcept
    : ring_{ring}, cycle_{cycle}, power_up_{power_up}, span_end_{power_up + span} {}

EventRecord CycleRecorder::record(EventKind kind, nanoseconds now) const noexcept {
  return {.kind = kind, .cycle = cycle_, .time_ns = (now - power_up_).count(), .scan_number = scan_number_};
}

void CycleRecorder::observe(const ScanTask& task, std::uint64_t scan_number, nanoseconds now) noexcept {
  observe_scan_end(task, now);
  scan_number_ = scan_number;
  if (now >= span_end_ || task.mode() != mode_ || task.fault() != fault_) {
    finish(now);
    span_end_ = now + span;
  }
  observe_fault(task.fault(), now);
  if (std::exchange(mode_, task.mode()) != mode_) {
    EventRecord change = record(EventKind::mode_change, now);
    change.code = static_cast<std::uint16_t>(mode_);
    (void)ring_.push(change);
  }
}

void CycleRecorder::observe_scan_end(const ScanTask& task, nanoseconds now) noexcept {
  // The task's own count begins anew with each start of RUN.
  const std::uint64_t scans = task.scan_times().scans_count;
  const bool scan_ended = std::exchange(scans_seen_, scans) < scans;
  if (scan_ended) {
    times_.add(task.scan_times().now);
    times_sum_ += task.scan_times().now;
  }
  const std::uint64_t overruns = task.period().overruns_count();
  if (std::exchange(overruns_seen_, overruns) == overruns) return;
  if (++overruns_ > overruns_per_span) return;
  EventRecord overrun = record(EventKind::overrun, now);
  overrun.values[0] = scan_ended ? task.scan_times().now.count() : -1;
  (void)ring_.push(overrun);
}

void CycleRecorder::observe_fault(const std::optional<Fault>& fault, nanoseconds now) noexcept {
  if (fault == fault_) return;
  if (fault_ && !fault) {
    EventRecord cleared = record(EventKind::fault_cleared, now);
    cleared.code = static_cast<std::uint16_t>(fault_->code);
    (void)ring_.push(cleared);
  }
  fault_ = fault;
  if (!fault) return;
  EventRecord entered = record(EventKind::fault, now);
  const SourcePlace place =
      fault->code == FaultCode::program_failed ? std::exchange(failed_at_, {0, 0}) : SourcePlace{0, 0};
  entered.code = static_cast<std::uint16_t>(fault->code);
  entered.scan_number = fault->scan_number;
  entered.values = {static_cast<std::int64_t>(fault->action), fault->scan_time.count(), place.line,
                    place.column};
  (void)ring_.push(entered);
}

void CycleRecorder::finish(nanoseconds now) noexcept {
  if (times_.scans_count == 0 && overruns_ == 0) return;
  EventRecord scans = record(EventKind::scans, now);
  scans.values = {static_cast<std::int64_t>(times_.scans_count), times_.shortest.count(),
                  times_.longest.count(), times_sum_.count(), static_cast<std::int64_t>(overruns_)};
  (void)ring_.push(scans);
  times_ = {};
  times_sum_ = nanoseconds{0};
  overruns_ = 0;
}

}  // namespace emulator_models::soft_plc
