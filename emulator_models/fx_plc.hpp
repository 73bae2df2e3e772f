// An FX PLC that runs a program of instruction list: the memory of FxPlcEmulator, scanned by a ScanTask in the classic
// four phases. No thread and no clock: the host brings the time, step by step (fx_plc_loop.hpp in real time).
//
//   1  system    requests of the programming port, RUN and STOP, special devices
//   2  inputs    X and D200-D207 from the terminals, latched once
//   3  program   in RUN, slice by slice
//   4  outputs   Y and D210-D217 to the terminals; off in STOP and with M8034
//
// Invariants
//   I1  from phase 1 to the end of the scan the memory is locked: requests and snapshots see it between two scans.
//   I2  a scan longer than D8000 ms, or one that begins so much too late, ends in STOP: outputs off, 6105 in D8061,
//       M8061 and M8004 on, lamp CPU-E lit; a run-time fault of the program likewise, with 67xx in D8067, its line in
//       D8069, M8067, M8004 and PROG-E.
//   I3  that is cleared by an order of RUN only: the switch from STOP to RUN, or M8035 with M8036.
// With M8039 on, a scan begins every D8039 ms instead of every FxPlcConfig::period.
// Left out: interrupts, immediate refresh, the WDT instruction. Not thread-safe.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "emulator_models/fx_plc_emulator.hpp"
#include "emulator_models/plants/terminals.hpp"
#include "emulator_models/scan_boundary_port.hpp"
#include "emulator_models/soft_plc/il_machine.hpp"
#include "emulator_models/soft_plc/scan_task.hpp"

namespace emulator_models {

struct FxPlcConfig {
  std::chrono::nanoseconds period = std::chrono::milliseconds{10};  ///< 0 to 1 h
  std::optional<std::chrono::milliseconds>
      watchdog_limit;                         ///< D8000 at power-up; without: 200 ms. 1 to 32767 ms
  std::uint64_t slice_instructions = 16'384;  ///< after which the watchdog looks
  std::uint64_t scan_instructions_max = soft_plc::IlMachine::default_budget;
  soft_plc::StartKind start = soft_plc::StartKind::warm;  ///< of RUN after a STOP; at power-up it is cold
};

class FxPlc final : private soft_plc::ScanProgram {
 public:
  /// What is wired to the terminals: reads outputs, sets inputs; called in phase 2, must neither throw nor call back.
  using Plant = std::function<void(Terminals&, SteadyTime)>;

  /// The RUN switch is on; the first scan is due at once.
  /// @param program  compiled with the FxAddressMap of the emulator's model
  /// @param port     served in phase 1, may be null; all references must outlive this
  FxPlc(FxPlcEmulator& emulator, const soft_plc::IlProgram& program, Plant plant, ScanBoundaryPort* port,
        const FxPlcConfig& config, SteadyTime now);

  /// @param observer  outlives this; null: nobody watches. Called on the thread that advances
  void observe_with(FxPlcObserver* observer) noexcept;

  /// Does the next step.
  /// @return it; `wait`: nothing is to be done before `until`, since the epoch of the steady clock
  soft_plc::ScanStep advance(SteadyTime now, WallTime wall) noexcept;

  /// Counts in the next scan; from off to on clears a fault.
  void set_run_switch(bool on) noexcept { run_switch_ = on; }
  /// The next start of RUN clears latched devices and retained variables, too.
  void order_cold_start() noexcept { cold_start_ordered_ = true; }

  [[nodiscard]] soft_plc::RunMode mode() const noexcept { return task_.mode(); }
  [[nodiscard]] const std::optional<soft_plc::Fault>& fault() const noexcept { return task_.fault(); }
  /// Where the program failed, when that is the fault.
  [[nodiscard]] const std::optional<soft_plc::RunTimeFault>& program_fault() const noexcept {
    return program_fault_;
  }
  [[nodiscard]] bool cpu_error_lamp() const noexcept { return cpu_error_lamp_; }
  [[nodiscard]] bool program_error_lamp() const noexcept { return program_error_lamp_; }
  [[nodiscard]] const Terminals& terminals() const noexcept { return terminals_; }
  [[nodiscard]] const soft_plc::ScanTask& task() const noexcept { return task_; }

 private:
  void system_analysis() noexcept override;
  void initialise(soft_plc::StartKind start) noexcept override;
  void read_inputs() noexcept override;
  void read_from_cycles() noexcept override {}
  soft_plc::Progress execute(const soft_plc::ScanStep& step) noexcept override;
  void write_to_cycles() noexcept override {}
  void refresh_output_image() noexcept override {}  // Y is the image
  void write_outputs() noexcept override;
  void write_safe_outputs() noexcept override;
  void set_alarm_lamp(bool on) noexcept override;

  void order_mode(bool power_up) noexcept;
  void set_period() noexcept;
  void show_times(bool power_up) noexcept;
  /// Whether the next scan of RUN has not begun for longer than the watchdog allows: the hardware re-triggers its
  /// watchdog at the end of each scan, and so must not only look while one is under way.
  [[nodiscard]] bool is_overdue() const noexcept;
  [[nodiscard]] DeviceMemory& memory() noexcept { return **locked_; }

  FxPlcEmulator& emulator_;
  soft_plc::IlMachine machine_;
  Plant plant_;
  ScanBoundaryPort* port_;
  FxPlcObserver* observer_ = nullptr;
  FxPlcConfig config_;
  soft_plc::ScanTask task_;
  std::chrono::nanoseconds period_;  ///< ordered, counts from the next scan
  Terminals terminals_;
  std::optional<FxPlcEmulator::LockedMemory> locked_;
  soft_plc::Progress last_progress_ = soft_plc::Progress::finished;
  bool first_scan_of_run_ = false;
  SteadyTime now_;
  WallTime wall_{};
  std::optional<SteadyTime> power_up_;
  std::chrono::nanoseconds watchdog_limit_{0};
  std::optional<std::int64_t> clock_step_;                   ///< that M8011 to M8014 show
  std::optional<std::chrono::sys_seconds> calendar_second_;  ///< that D8013 to D8019 show
  std::size_t analog_inputs_index_ = 0;                      ///< of D200 and of D210 in the memory's bytes
  std::size_t analog_outputs_index_ = 0;
  bool run_switch_ = true;
  bool run_switch_seen_ = true;
  bool cold_start_ordered_ = false;
  bool has_run_ = false;
  std::optional<soft_plc::RunTimeFault> program_fault_;
  bool cpu_error_lamp_ = false;
  bool program_error_lamp_ = false;
};

}  // namespace emulator_models
