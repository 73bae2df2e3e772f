#include "emulator_models/soft_plc/scan_task.hpp"

#include <algorithm>
#include <utility>

namespace emulator_models::soft_plc {

using std::chrono::nanoseconds;

std::string_view to_string(ScanConfigError error) noexcept {
  switch (error) {
    case ScanConfigError::period_out_of_range:
      return "the period must be 0 (no waiting) or a time of up to 1 h";
    case ScanConfigError::watchdog_limit_out_of_range:
      return "the watchdog's limit must be above 0 and up to 1 h; usual is 150 ms";
  }
  return "";
}

tl::expected<ScanTask, ScanConfigError> ScanTask::make(const ScanConfig& config, nanoseconds now) noexcept {
  if (config.period < nanoseconds{0} || config.period > ScanConfig::duration_max)
    return tl::unexpected{ScanConfigError::period_out_of_range};
  if (config.watchdog_limit <= nanoseconds{0} || config.watchdog_limit > ScanConfig::duration_max)
    return tl::unexpected{ScanConfigError::watchdog_limit_out_of_range};
  return ScanTask{config, now};
}

ScanTask::ScanTask(const ScanConfig& config, nanoseconds now) noexcept
    : config_{config},
      period_{config.period, config.overrun, now},
      watchdog_{config.watchdog_limit},
      now_{now},
      scan_start_{now} {}

bool ScanTask::order_run(StartKind start) noexcept {
  if ((fault_ || halt_code_) && !reset_was_ordered_) return false;
  ordered_mode_ = RunMode::run;
  ordered_start_ = start;
  return true;
}

void ScanTask::order_stop() noexcept {
  ordered_mode_ = RunMode::stop;
  stop_was_ordered_ = true;
}

void ScanTask::order_reset() noexcept {
  if (fault_) reset_was_ordered_ = true;
}

void ScanTask::halt(FaultCode code) noexcept {
  if (!fault_) {
    if (!halt_code_) halt_code_ = code;
    return;
  }
  // What was ordered before this cannot have been meant for it.
  reset_was_ordered_ = false;
  ordered_mode_ = RunMode::stop;
}

bool ScanTask::is_ready(nanoseconds now) const noexcept {
  return action_ != ScanAction::wait || halt_code_ || std::max(now_, now) >= period_.due();
}

bool ScanTask::is_urgent(nanoseconds now) const noexcept {
  return halt_code_ || (action_ != ScanAction::wait && watchdog_bites(std::max(now_, now)));
}

bool ScanTask::watchdog_bites(nanoseconds now) const noexcept {
  return mode_ == RunMode::run && watchdog_.bites(now);
}

ScanStep ScanTask::next(nanoseconds now, Progress last) noexcept {
  now_ = std::max(now_, now);
  if (halt_code_) return enter_fault(*std::exchange(halt_code_, std::nullopt));
  if (action_ == ScanAction::wait) return now_ < period_.due() ? step(ScanAction::wait) : begin_scan();
  if (!fault_ && last == Progress::failed) return enter_fault(FaultCode::program_failed);
#ifdef LTSIM_MUTANT_WATCHDOG_FED_BY_SLICES  // whatever comes to its end earns more time
  watchdog_.begin_scan(now_);
#endif
  if (watchdog_bites(now_)) return enter_fault(FaultCode::watchdog);
  return last == Progress::unfinished ? step(action_) : after(action_);
}

ScanStep ScanTask::step(ScanAction action) noexcept {
  action_ = action;
  return {.action = action,
          .until = action == ScanAction::wait ? period_.due() : watchdog_.deadline(),
          .scan_start = scan_start_,
          .first_scan = first_scan_,
          .start = start_};
}

ScanStep ScanTask::enter_fault(FaultCode code) noexcept {
  fault_ = Fault{code, action_, scan_number_, now_ - scan_start_};
  mode_ = ordered_mode_ = RunMode::stop;
  return step(ScanAction::enter_fault);
}

ScanStep ScanTask::begin_scan() noexcept {
  const bool starts_were_lost = period_.begin_scan(now_);
  if (const auto next = std::exchange(next_config_, std::nullopt)) {
    config_.overrun = next->overrun;
    period_.change(next->period, next->overrun);
    watchdog_ = Watchdog{next->watchdog_limit};
  }
  scan_start_ = now_;
  scan_is_open_ = true;
  ++scan_number_;
  first_scan_ = false;
  watchdog_.begin_scan(now_);
  if (starts_were_lost && config_.overrun == OverrunRule::stop && mode_ == RunMode::run)
    return enter_fault(FaultCode::overrun);
  return step(ScanAction::system_analysis);
}

ScanStep ScanTask::change_mode() noexcept {
#ifdef LTSIM_MUTANT_MODE_SAMPLED  // a STOP that no scan has seen is forgotten
  stop_was_ordered_ = false;
#endif
  const bool was_stopped = std::exchange(stop_was_ordered_, false);
  const RunMode before = std::exchange(mode_, ordered_mode_);
  if (mode_ == RunMode::run && (before == RunMode::stop || was_stopped)) {
    first_scan_ = true;
    start_ = ordered_start_;
    scan_times_ = {};
    return step(ScanAction::initialise);
  }
  if (mode_ == RunMode::stop && before == RunMode::run && config_.outputs_in_stop == OutputsInStop::safe)
    return step(ScanAction::write_safe_outputs);
  return step(ScanAction::read_inputs);
}

ScanStep ScanTask::after(ScanAction finished) noexcept {
  switch (finished) {
    case ScanAction::system_analysis:
      if (std::exchange(reset_was_ordered_, false)) {
        fault_.reset();
        return step(ScanAction::clear_fault);
      }
      return change_mode();
    case ScanAction::clear_fault:
      return change_mode();
    case ScanAction::initialise:
    case ScanAction::write_safe_outputs:
      return step(ScanAction::read_inputs);
    case ScanAction::read_inputs:
#ifdef LTSIM_MUTANT_MODE_READ_TWICE  // the mode that is ordered meanwhile counts for the scan under way
      if (ordered_mode_ == RunMode::run) return step(ScanAction::execute);
#endif
      if (mode_ == RunMode::stop) return step(ScanAction::refresh_output_image);
      return step(config_.exchanges_with_cycles ? ScanAction::read_from_cycles : ScanAction::execute);
    case ScanAction::read_from_cycles:
      return step(ScanAction::execute);
    case ScanAction::execute:
      return step(config_.exchanges_with_cycles ? ScanAction::write_to_cycles : ScanAction::write_outputs);
    case ScanAction::write_to_cycles:
      return step(ScanAction::write_outputs);
    case ScanAction::write_outputs:
      scan_times_.add(now_ - scan_start_);
      return end_scan();
    case ScanAction::refresh_output_image:
      return end_scan();
    case ScanAction::enter_fault:
      return scan_is_open_ ? end_scan() : step(ScanAction::wait);
    case ScanAction::wait:
      break;
  }
  return step(ScanAction::wait);
}

ScanStep ScanTask::end_scan() noexcept {
  scan_is_open_ = false;
  const bool overrun = period_.end_scan(now_);
  if (overrun && config_.overrun == OverrunRule::stop && mode_ == RunMode::run)
    return enter_fault(FaultCode::overrun);
  return step(ScanAction::wait);
}

}  // namespace emulator_models::soft_plc
