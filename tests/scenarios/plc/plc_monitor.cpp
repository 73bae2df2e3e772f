#include "tests/scenarios/plc/plc_monitor.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace scenarios {

void PlcMonitor::run_ordered() {
  ++runs_count_;
  world_.note([&] { return fmt::format("RUN {} ordered", runs_count_); });
  lamp_was_off_ = was_over_time_ = false;
}

void PlcMonitor::stop_ordered() {
  world_.note([] { return std::string{"STOP ordered"}; });
  stop_ordered_at_ = world_.now();
  for (Cycle& cycle : cycles_) cycle.stop_seen = false;
}

void PlcMonitor::stopped() { last_dead_run_ = runs_count_; }

void PlcMonitor::clock_read(Nanoseconds read) {
  if (read != world_.now()) wrong_readings_.emplace(read, world_.now());
}

void PlcMonitor::initialised(std::size_t index) {
  Cycle& cycle = cycles_[index];
  world_.note([&] { return fmt::format("cycle {} begins run {}", index, runs_count_); });
  cycle.run = runs_count_;
  cycle.is_initialised = cycle.must_be_first = cycle.stop_seen = true;
  cycle.is_in_scan = false;
}

void PlcMonitor::slice_begins(std::size_t index, Nanoseconds scan_start, bool first_scan) {
  Cycle& cycle = cycles_[index];
  look_at_lamp();
  const auto wrong = wrong_readings_.find(scan_start);
  if (!cycle.is_in_scan)
    begin_scan(cycle, index, wrong == wrong_readings_.end() ? scan_start : wrong->second, first_scan);
  ++cycle.slices_in_scan;
}

void PlcMonitor::begin_scan(Cycle& cycle, std::size_t index, Nanoseconds scan_start, bool first_scan) {
  world_.note([&] { return fmt::format("cycle {} executes", index); });
  require(cycle.is_initialised,
          "I25: a scan executes the program, and no initialisation since the last STOP has preceded it");
  require(cycle.stop_seen || scan_start <= stop_ordered_at_,
          "I25: a scan that began after STOP and RUN were ordered goes on as if there had been no STOP");
  require(first_scan == cycle.must_be_first, "I25: not exactly the first scan of a run is told so");
  const bool was_over_time = !cycle.must_be_first && may_be_over_time(cycle);
  cycle.must_be_first = false;
  cycle.is_in_scan = true;
  cycle.slices_in_scan = 0;
  cycle.first_slice = world_.now();
  cycle.began_after = scan_start;
  was_over_time_ = was_over_time_ || was_over_time || may_be_over_time(cycle);
  cycle.input.reset();
  cycle.field_word.reset();
  cycle.starts.push_back(scan_start);
  check_spacing(cycle, index);
}

void PlcMonitor::check_spacing(const Cycle& cycle, std::size_t index) {
  const Nanoseconds last = cycle.starts.back();
  std::uint64_t count = 0;
  for (auto start = cycle.starts.rbegin(); start != cycle.starts.rend(); ++start) {
    const auto periods =
        static_cast<std::uint64_t>(std::max<std::int64_t>((last - *start) / options_.periods[index], 0));
    require(++count <= periods + 2 + options_.burst, "I26: more scans start than their period allows");
  }
}

void PlcMonitor::input_read(std::size_t index, std::uint64_t value) {
  Cycle& cycle = cycles_[index];
  require(cycle.input.value_or(value) == value, "I23: an input changes within a scan");
  cycle.input = value;
}

void PlcMonitor::field_words_read(std::size_t index, std::uint64_t first, std::uint64_t second) {
  Cycle& cycle = cycles_[index];
  require(first == second, "gateway: a scan sees one half of a write");
  require(cycle.field_word.value_or(first) == first, "gateway: a write arrives in the middle of a scan");
  require(!given_up_.contains(first), "gateway: a write is carried out after it was given up");
  cycle.field_word = first;
}

void PlcMonitor::gateway_answered(std::uint64_t written, const std::array<std::uint64_t, 2>& program_words,
                                  const std::array<std::uint64_t, 2>& field_words) {
  require(program_words[0] == program_words[1], "gateway: a request sees a scan half done");
  require(field_words[0] == written && field_words[1] == written,
          "gateway: a request does not read what it has written");
}

void PlcMonitor::scan_computed(std::size_t index) {
  Cycle& cycle = cycles_[index];
  cycle.is_in_scan = false;
  cycle.computed_in.push_back(cycle.run);
}

void PlcMonitor::gave_up(std::size_t index) {
  Cycle& cycle = cycles_[index];
  world_.note([&] { return fmt::format("cycle {} has made the outputs safe", index); });
  was_over_time_ = was_over_time_ || may_be_over_time(cycle);
  look_at_lamp();
  cycle.is_in_scan = cycle.is_initialised = false;
  cycle.began_after = world_.now();
  last_dead_run_ = std::max(last_dead_run_, cycle.run);
}

void PlcMonitor::terminals_written(const std::array<std::uint32_t, cycles_count>& words) {
  world_.note([&] { return fmt::format("terminals {:#x} {:#x}", words[0], words[1]); });
  look_at_lamp();
  for (std::size_t i = 0; i < cycles_count; ++i) {
    if (words[i] == 0) continue;
    const std::uint32_t scan = words[i] >> 16U;
    const auto& computed_in = cycles_[i].computed_in;
    const bool is_whole = words[i] == outputs_of(scan) && scan <= computed_in.size();
    require(is_whole, "I24: the terminals show outputs that are not those of a whole scan");
    if (!is_whole || computed_in[scan - 1] > last_dead_run_) continue;
    require(words[i] == terminals_[i], "I19: an output of a run is written after that run was stopped");
    require(words == terminals_,
            "I24: some terminals have become safe, and others show what a scan has left");
  }
  terminals_ = words;
}

void PlcMonitor::require(bool holds, std::string_view message) {
  if (holds || !message.starts_with(options_.only)) return;
  world_.require(false, message);
}

void PlcMonitor::look_at_lamp() {
  if (!lamp_) return;
  const ltsim::GhostScope ghost;
  if (!lamp_()) {
    lamp_was_off_ = true;
    return;
  }
  if (!std::exchange(lamp_was_off_, false)) return;
  require(was_over_time_ ||
              std::ranges::any_of(cycles_, [&](const Cycle& each) { return may_be_over_time(each); }),
          "I21: the PLC is stopped by a fault, though no scan of this run has lasted longer than the "
          "watchdog allows");
}

bool PlcMonitor::may_be_over_time(const Cycle& cycle) const noexcept {
  return world_.now() - cycle.began_after > options_.watchdog_limit;
}

void PlcMonitor::computes() {
  const ltsim::GhostScope ghost;
  const ltsim::Scheduler& scheduler = world_.scheduler();
  for (ltsim::TaskId id = 0; id < scheduler.tasks_count(); ++id) {
    if (scheduler.task(id).state == ltsim::Task::State::stalled) held_up_at_ = world_.now();
  }
  if (world_.now() - held_up_at_ > watchdog_work) require_watchdog(watchdog_work);
}

void PlcMonitor::idle() {
  require_watchdog(watchdog_delta);
  if (lamp_) look_at_lamp();
}

void PlcMonitor::require_watchdog(Nanoseconds delta) {
  if (!lamp_) return;
  for (Cycle& cycle : cycles_) {
    if (!cycle.is_in_scan || world_.now() - cycle.first_slice <= options_.watchdog_limit + delta) continue;
    require(cycle.slices_in_scan == 1 || lamp_(),
            "I22: slices of the program have earned their scan more time");
    require(lamp_(), "I20: a scan lasts longer than the watchdog's limit, and the PLC is not stopped");
    // While it has not come back no RUN is accepted.
    last_dead_run_ = runs_count_;
  }
}

}  // namespace scenarios
