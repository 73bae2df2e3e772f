#include "emulator_models/scan_cycle.hpp"

#include <algorithm>

#include "emulator_models/machine_devices.hpp"
#include "protocol/check.hpp"
#include "protocol/fx/device_ranges.hpp"

namespace emulator_models {
namespace {

using protocol::fx::Device;
using protocol::fx::DeviceKind;

constexpr Device keep_memory_in_stop{DeviceKind::m, 8033};
constexpr Device all_outputs_off{DeviceKind::m, 8034};

}  // namespace

ScanCycle::ScanCycle(FxPlcEmulator& plc, MachineProgram& program, MachinePlant& plant,
                     std::chrono::nanoseconds period) noexcept
    : plc_{plc}, program_{program}, plant_{plant}, period_{period} {
  PLC_CHECK(period > std::chrono::nanoseconds{0});
}

void ScanCycle::scan_once(SteadyTime now, WallTime wall) noexcept {
  plant_.advance(terminals_, now);
  plc_.with_memory([&](DeviceMemory& memory) {
    serve_system(memory, now, wall);
    latch_inputs(memory);
    if (mode_ != RunMode::stop) program_.run(memory, now);
    write_outputs(memory);
  });
  ++scans_count_;
}

void ScanCycle::serve_system(DeviceMemory& memory, SteadyTime now, WallTime wall) noexcept {
  const bool power_up = scans_count_ == 0;
  if (power_up) power_up_ = now;
  const bool was_running = mode_ != RunMode::stop;
  if (!obey_remote_switch(memory, was_running || power_up)) {
    mode_ = RunMode::stop;
  } else if (was_running) {
    mode_ = RunMode::run;
  } else {
    mode_ = RunMode::first_run_scan;
    if (!power_up && memory.get(keep_memory_in_stop) == 0) memory.clear_not_latched();
  }
  set_run_flags(memory, mode_);
  set_clock_flags(memory, now - power_up_);
  set_calendar(memory, wall);
  if (!power_up) set_scan_time(memory, last_scan_time_);
}

void ScanCycle::latch_inputs(DeviceMemory& memory) const noexcept {
  const std::uint16_t inputs_count = protocol::fx::ranges_of(memory.model()).x;
  for (std::uint16_t i = 0; i < inputs_count; ++i) memory.set({DeviceKind::x, i}, terminals_.inputs.test(i));
}

void ScanCycle::write_outputs(const DeviceMemory& memory) noexcept {
  const bool enabled = mode_ != RunMode::stop && memory.get(all_outputs_off) == 0;
  const std::uint16_t outputs_count = protocol::fx::ranges_of(memory.model()).y;
  for (std::uint16_t i = 0; i < outputs_count; ++i)
    terminals_.outputs.set(i, enabled && memory.get({DeviceKind::y, i}) != 0);
  terminals_.analog_outputs[0] =
      enabled ? static_cast<std::uint16_t>(memory.get(machine::spindle_speed)) : std::uint16_t{0};
}

void ScanCycle::run() noexcept {
  SteadyTime start = std::chrono::steady_clock::now();
  while (wait_until(start)) {
    const SteadyTime began = std::chrono::steady_clock::now();
    scan_once(began, std::chrono::system_clock::now());
    const SteadyTime ended = std::chrono::steady_clock::now();
    last_scan_time_ = ended - began;
    const auto missed_starts = std::max<std::int64_t>(0, (ended - start) / period_ - 1);
    start += period_ * (1 + missed_starts);
  }
}

void ScanCycle::request_stop() noexcept {
  {
    const std::lock_guard lock{stop_mutex_};
    stop_requested_ = true;
  }
  stop_condition_.notify_all();
}

bool ScanCycle::wait_until(SteadyTime start) {
  std::unique_lock lock{stop_mutex_};
  return !stop_condition_.wait_until(lock, start, [this] { return stop_requested_; });
}

}  // namespace emulator_models
