// A cycle whose steps take simulated time, and that writes down what it was asked to do.
#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <utility>

#include "emulator_models/soft_plc/scan_task.hpp"

namespace emulator_models::soft_plc {

class ScanRig final : public ScanProgram {
 public:
  /// How long a call takes; execute: one slice.
  std::chrono::nanoseconds& duration_of(ScanAction action) {
    return durations_[static_cast<std::size_t>(action)];
  }

  int slices_per_scan = 1;
  /// Called in the middle of a step, after half of its duration.
  std::function<void(ScanAction)> during = [](ScanAction) {};
  bool fails = false;

  std::chrono::nanoseconds now{0};
  /// One letter a call: A analysis, N initialise, I inputs, F from cycles, X execute (one slice), T to cycles,
  /// G image, O outputs, S safe outputs, L lamp on, l lamp off.
  std::string calls;
  ScanStep last_execute;

  std::string take_calls() { return std::exchange(calls, {}); }

  /// Carries out steps until the task waits; nothing if its next scan is not due.
  void run_until_wait(ScanTask& task);

  void system_analysis() noexcept override { spend('A', ScanAction::system_analysis); }
  void initialise(StartKind) noexcept override { spend('N', ScanAction::initialise); }
  void read_inputs() noexcept override { spend('I', ScanAction::read_inputs); }
  void read_from_cycles() noexcept override { spend('F', ScanAction::read_from_cycles); }
  Progress execute(const ScanStep& step) noexcept override;
  void write_to_cycles() noexcept override { spend('T', ScanAction::write_to_cycles); }
  void refresh_output_image() noexcept override { spend('G', ScanAction::refresh_output_image); }
  void write_outputs() noexcept override { spend('O', ScanAction::write_outputs); }
  void write_safe_outputs() noexcept override;
  void set_alarm_lamp(bool on) noexcept override { calls += on ? 'L' : 'l'; }

 private:
  void spend(char letter, ScanAction action) noexcept;

  std::array<std::chrono::nanoseconds, 12> durations_{};
  int slices_done_ = 0;
};

}  // namespace emulator_models::soft_plc
