#include "emulator_models/soft_plc/scan_scheduler.hpp"

#include <algorithm>

namespace emulator_models::soft_plc {

using std::chrono::nanoseconds;

std::string_view to_string(SchedulerConfigError error) noexcept {
  switch (error) {
    case SchedulerConfigError::cycle_refused:
      return "the period or the watchdog's limit of a cycle is out of range";
    case SchedulerConfigError::priority_unknown:
      return "a cycle has a priority for which there is no slice interval; give one interval for each "
             "priority from 0 on";
    case SchedulerConfigError::slice_interval_out_of_range:
      return "a slice interval must be 0 (always) or a time of up to 1 h";
  }
  return "";
}

tl::expected<ScanScheduler, SchedulerConfigError> ScanScheduler::make(const SchedulerConfig& config,
                                                                      nanoseconds now) {
  ScanScheduler scheduler;
  for (const nanoseconds interval : config.slice_intervals) {
    if (interval < nanoseconds{0} || interval > ScanConfig::duration_max)
      return tl::unexpected{SchedulerConfigError::slice_interval_out_of_range};
    scheduler.timers_.push_back({interval, now});
  }
  for (const CycleConfig& cycle : config.cycles) {
    if (cycle.priority >= config.slice_intervals.size())
      return tl::unexpected{SchedulerConfigError::priority_unknown};
    const auto task = ScanTask::make(cycle.scan, now);
    if (!task) return tl::unexpected{SchedulerConfigError::cycle_refused};
    scheduler.cycles_.push_back({.task = *task, .priority = cycle.priority, .last_served = now});
  }
  return scheduler;
}

ScanScheduler::Slice ScanScheduler::next(nanoseconds now, Progress last) noexcept {
  if (running_) {
    cycles_[*running_].last = last;
    cycles_[*running_].last_served = now;
    running_.reset();
  }
  // A cycle that only ends its scan here costs no slice. Each does so once: then it waits, or begins the next.
  while (const auto index = choose(now)) {
    Cycle& cycle = cycles_[*index];
    const ScanStep step = cycle.task.next(now, cycle.last);
    cycle.last = Progress::finished;
    cycle.in_scan = step.action != ScanAction::wait;
    if (step.action == ScanAction::enter_fault) halt_others(*index);
    if (!cycle.in_scan) continue;
    use_tick(timers_[cycle.priority], now);
    cycle.last_slice_number = ++slices_count_;
    running_ = index;
    return {index, step};
  }
  ScanStep wait{.until = nanoseconds::max()};
  for (const Cycle& cycle : cycles_) wait.until = std::min(wait.until, cycle.task.period().due());
  return {std::nullopt, wait};
}

nanoseconds ScanScheduler::Cycle::waiting_since() const noexcept {
  return in_scan ? last_served : std::max(last_served, task.period().due());
}

bool ScanScheduler::Cycle::waits_longer_than(const Cycle& other) const noexcept {
  const nanoseconds mine = waiting_since();
  const nanoseconds theirs = other.waiting_since();
  return mine != theirs ? mine < theirs : last_slice_number < other.last_slice_number;
}

std::optional<std::size_t> ScanScheduler::choose(nanoseconds now) const noexcept {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < cycles_.size(); ++i) {
    if (cycles_[i].task.is_ready(now) && (!best || goes_before(cycles_[i], cycles_[*best], now))) best = i;
  }
  return best;
}

bool ScanScheduler::goes_before(const Cycle& a, const Cycle& b, nanoseconds now) const noexcept {
  const auto is_urgent = [now](const Cycle& cycle) {
    return cycle.last == Progress::failed || cycle.task.is_urgent(now);
  };
  if (is_urgent(a) != is_urgent(b)) return is_urgent(a);
  if (a.priority == b.priority) return a.waits_longer_than(b);
  const nanoseconds tick_a = std::max(timers_[a.priority].tick, now);
  const nanoseconds tick_b = std::max(timers_[b.priority].tick, now);
  return tick_a != tick_b ? tick_a < tick_b : a.priority < b.priority;
}

void ScanScheduler::use_tick(Timer& timer, nanoseconds now) noexcept {
  if (timer.interval > nanoseconds{0} && timer.tick <= now)
    timer.tick += ((now - timer.tick) / timer.interval + 1) * timer.interval;
}

void ScanScheduler::halt_others(std::size_t index) noexcept {
  // Those that were halted themselves do not halt again: it was one of the others that began.
  if (cycles_[index].task.fault()->code == FaultCode::other_cycle) return;
  for (Cycle& cycle : cycles_) cycle.task.halt(FaultCode::other_cycle);
}

}  // namespace emulator_models::soft_plc
