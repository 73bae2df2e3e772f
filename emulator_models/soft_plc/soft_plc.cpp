#include "emulator_models/soft_plc/soft_plc.hpp"

#include <algorithm>
#include <utility>

namespace emulator_models::soft_plc {
namespace {

using std::chrono::nanoseconds;

std::vector<Section> sections_of(const SoftPlcSetup& setup) {
  std::vector<Section> sections;
  for (const PlcCycleSetup& cycle : setup.cycles) sections.push_back(cycle.sends);
  return sections;
}

bool share_a_bit(std::span<const std::byte> a, std::span<const std::byte> b) noexcept {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if ((a[i] & b[i]) != std::byte{0}) return true;
  }
  return false;
}

/// @return what is wrong with a pair of cycles; empty if nothing
std::string conflict(const PlcCycleSetup& a, const PlcCycleSetup& b) {
  const std::string names = "cycles " + a.name + " and " + b.name;
  if (a.sends.overlaps(b.sends))
    return names + " send the same words; each word has one owner, give them sections apart";
  if (share_a_bit(a.body->output_mask(), b.body->output_mask()))
    return names +
           " write the same output; each output has one owner, let one cycle send what it wants to the other";
  if (a.config.scan.outputs_in_stop != b.config.scan.outputs_in_stop)
    return names + " disagree about outputs in STOP; it is one rule for all";
  return {};
}

}  // namespace

tl::expected<std::unique_ptr<SoftPlc>, std::string> SoftPlc::make(SoftPlcSetup setup, nanoseconds now) {
  const auto& cycles = setup.cycles;
  if (cycles.empty() || cycles.size() > cycles_max)
    return tl::unexpected{std::string{"a PLC has 1 to 32 cycles"}};
  SchedulerConfig config{.cycles = {}, .slice_intervals = setup.slice_intervals};
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    config.cycles.push_back(cycles[i].config);
    const CycleImage image = cycles[i].body->image();
    if (image.inputs.size() > inputs_bytes_max || image.outputs.size() > outputs_bytes_max ||
        cycles[i].body->output_mask().size() > image.outputs.size())
      return tl::unexpected{"the image of cycle " + cycles[i].name +
                            " is too long: at most 256 bytes each way"};
    if (!cycles[i].sends.fits(std::min(image.memory.size(), memory_bytes_max)))
      return tl::unexpected{"cycle " + cycles[i].name + " sends words that lie beyond its memory"};
    for (std::size_t k = 0; k < i; ++k) {
      if (std::string what = conflict(cycles[k], cycles[i]); !what.empty()) return tl::unexpected{what};
    }
  }
  auto scheduler = ScanScheduler::make(config, now);
  if (!scheduler) return tl::unexpected{std::string{to_string(scheduler.error())}};
  return std::unique_ptr<SoftPlc>{new SoftPlc{std::move(setup), std::move(*scheduler), now}};
}

SoftPlc::SoftPlc(SoftPlcSetup setup, ScanScheduler scheduler, nanoseconds now)
    : parts_{VariableExchange{sections_of(setup)},
             IoManager{std::move(setup.drivers), now},
             OutputGate{setup.safe_outputs},
             {},
             setup.observer},
      scheduler_{std::move(scheduler)},
      holds_outputs_{setup.cycles[0].config.scan.outputs_in_stop == OutputsInStop::hold} {
  std::vector<CycleImage> images;
  for (const PlcCycleSetup& cycle : setup.cycles) images.push_back(cycle.body->image());
  gateway_ = std::make_unique<Gateway>(setup.gateway, images, parts_.exchange);
  for (std::size_t i = 0; i < setup.cycles.size(); ++i) {
    PlcCycleSetup& cycle = setup.cycles[i];
    cycles_.push_back({.name = std::move(cycle.name),
                       .program = std::make_unique<PlcCycle>(i, std::move(cycle.body), parts_, *gateway_),
                       .priority = cycle.config.priority,
                       .config = cycle.config.scan,
                       .limit = std::nullopt,
                       .start_delays = {}});
  }
}

bool SoftPlc::order_run(StartKind start) noexcept {
  const std::lock_guard lock{mutex_};
  if (run_is_ordered_) return true;
  if (is_retired_) return false;
  for (const Cycle& cycle : cycles_) {
    if (cycle.halt_pending) return false;
  }
  // A fault in one cycle is one in all of them, as a reset is: the first refuses, or none.
  for (std::size_t i = 0; i < cycles_.size(); ++i) {
    if (!scheduler_.cycle(i).order_run(start)) return false;
  }
  run_ = parts_.gate.open(holds_outputs_);
  run_is_ordered_ = true;
  return true;
}

void SoftPlc::order_stop() noexcept {
  const std::lock_guard lock{mutex_};
  run_is_ordered_ = false;
  for (std::size_t i = 0; i < cycles_.size(); ++i) scheduler_.cycle(i).order_stop();
}

void SoftPlc::stop_now() noexcept {
  order_stop();
  const std::lock_guard lock{mutex_};
  static_cast<void>(parts_.gate.close(run_));
}

bool SoftPlc::retire() noexcept {
  const std::lock_guard lock{mutex_};
  is_retired_ = is_retired_ || is_stopped_locked();
  return is_retired_;
}

bool SoftPlc::order_reset() noexcept {
  const std::lock_guard lock{mutex_};
  for (const Cycle& cycle : cycles_) {
    if (cycle.halt_pending) return false;
  }
  for (std::size_t i = 0; i < cycles_.size(); ++i) scheduler_.cycle(i).order_reset();
  return true;
}

void SoftPlc::prepare(std::size_t index, const ScanStep& step) noexcept {
  Cycle& cycle = cycles_[index];
  cycle.limit.reset();
  if (step.action == ScanAction::wait) return;
  cycle.limit = step.until;
  const ScanTask& task = scheduler_.cycle(index);
  if (step.action == ScanAction::initialise) {
    cycle.program->begin_run(run_);
    cycle.start_delays = {};
    cycle.start_delays.add(task.period().start_delay());
  } else if (step.action == ScanAction::system_analysis && task.mode() == RunMode::run) {
    cycle.start_delays.add(task.period().start_delay());
  }
  if (step.action != ScanAction::enter_fault) return;
  if (!std::exchange(cycle.halt_pending, false)) stop_all(nanoseconds::min(), FaultCode::other_cycle);
  cycle.halt_pending = false;
}

void SoftPlc::stop_all(nanoseconds now, FaultCode others) noexcept {
  // The outputs first: who sees the lamp can rely on them.
  static_cast<void>(parts_.gate.close(run_));
  run_is_ordered_ = false;
  for (std::size_t i = 0; i < cycles_.size(); ++i) {
    ScanTask& task = scheduler_.cycle(i);
    const bool has_expired = !cycles_[i].halt_pending && task.is_urgent(now);
    parts_.lamp.set(i, true);
    if (task.fault() && !cycles_[i].halt_pending) {
      task.halt(others);  // voids what was ordered to end the fault
      continue;
    }
    task.halt(has_expired ? FaultCode::watchdog : others);
    cycles_[i].halt_pending = true;
  }
}

void SoftPlc::tell_observer(std::size_t index, nanoseconds now) noexcept {
  parts_.observer->step_ordered(index, scheduler_.cycle(index), cycles_[index].program->image(), now);
}

nanoseconds SoftPlc::advance(nanoseconds now) noexcept {
  ScanStep step;
  {
    const std::lock_guard lock{mutex_};
    const Progress last = running_ ? cycles_[*running_].last : Progress::finished;
    const ScanScheduler::Slice slice = scheduler_.next(now, last);
    running_ = slice.cycle;
    step = slice.step;
    for (std::size_t i = 0; parts_.observer != nullptr && i < cycles_.size(); ++i) tell_observer(i, now);
    if (!running_) return step.until;
    prepare(*running_, step);
  }
  cycles_[*running_].last = perform(step, *cycles_[*running_].program);
  return now;
}

nanoseconds SoftPlc::advance_cycle(std::size_t index, nanoseconds now) noexcept {
  Cycle& cycle = cycles_[index];
  ScanStep step;
  {
    const std::lock_guard lock{mutex_};
    step = scheduler_.cycle(index).next(now, cycle.last);
    if (parts_.observer != nullptr) tell_observer(index, now);
    prepare(index, step);
    if (step.action == ScanAction::wait) return step.until;
  }
  cycle.last = perform(step, *cycle.program);
  return now;
}

nanoseconds SoftPlc::supervise(nanoseconds now) noexcept {
  const bool io_failed = parts_.io.supervise(now).has_value();
  const std::lock_guard lock{mutex_};
  bool has_expired = false;
  nanoseconds next = std::min(parts_.io.next_look(), now + ScanConfig::duration_max);
  for (std::size_t i = 0; i < cycles_.size(); ++i) {
    const Cycle& cycle = cycles_[i];
    has_expired = has_expired || (!cycle.halt_pending && scheduler_.cycle(i).is_urgent(now));
    // A scan that is yet to begin has its limit no earlier than this.
    next = std::min(next, now + cycle.config.watchdog_limit + nanoseconds{1});
    if (cycle.limit && *cycle.limit >= now && scheduler_.cycle(i).is_in_scan())
      next = std::min(next, *cycle.limit + nanoseconds{1});
  }
#ifdef LTSIM_MUTANT_WATCHDOG_FED_BY_DRIVERS  // a driver that works earns the scan more time
  has_expired = has_expired && parts_.io.state(0, now).age > cycles_[0].config.watchdog_limit;
#endif
#ifdef LTSIM_MUTANT_WATCHDOG_OF_ANY_RUN  // the run that has expired need not be the one that is stopped
  mutex_.unlock();
  mutex_.lock();
#endif
  if (has_expired) {
    stop_all(now, FaultCode::other_cycle);
  } else if (io_failed && run_is_ordered_) {
    stop_all(now, FaultCode::io_failed);
  }
  return next;
}

tl::expected<void, std::string> SoftPlc::reconfigure(const std::vector<ScanConfig>& scans,
                                                     const GatewayLimits& gateway) noexcept {
  const std::lock_guard lock{mutex_};
  if (scans.size() != cycles_.size()) return tl::unexpected{std::string{"the number of cycles differs"}};
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (const auto task = ScanTask::make(scans[i], nanoseconds{0}); !task)
      return tl::unexpected{"cycle " + cycles_[i].name + ": " + std::string{to_string(task.error())}};
  }
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scheduler_.cycle(i).reconfigure(scans[i]);
    cycles_[i].config = scans[i];
  }
  gateway_->set_limits(gateway);
  return {};
}

CycleStatus SoftPlc::status(std::size_t index) const noexcept {
  const std::lock_guard lock{mutex_};
  const ScanTask& task = scheduler_.cycle(index);
  return {task.mode(), task.fault(), task.scan_times(), task.period().overruns_count(),
          task.period().lost_starts_count()};
}

StartDelays SoftPlc::start_delays(std::size_t index) const noexcept {
  const std::lock_guard lock{mutex_};
  return cycles_[index].start_delays;
}

bool SoftPlc::is_stopped() const noexcept {
  const std::lock_guard lock{mutex_};
  return is_stopped_locked();
}

bool SoftPlc::is_stopped_locked() const noexcept {
  if (run_is_ordered_) return false;
  for (std::size_t i = 0; i < cycles_.size(); ++i) {
    if (scheduler_.cycle(i).mode() != RunMode::stop) return false;
  }
  return true;
}

}  // namespace emulator_models::soft_plc
