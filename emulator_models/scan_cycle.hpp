// The scan of the PLC: the four classic phases, again and again.
//
//   1  system    change between RUN and STOP, special devices
//   2  inputs    latched once: the program sees only the latched image
//   3  program   in RUN only
//   4  outputs   all terminals at once; in STOP, and with M8034 on, all off
//
// Requests from the programming port are served between two scans: a scan holds the PLC's memory from phase 1
// to phase 4. A mode lasts for whole scans. After a STOP, the first scan of RUN begins with the memory
// cleared where it is not latched, unless M8033 is on.
//
// Left out: interrupt inputs, immediate refresh, constant scan by D8039, and the watchdog's bite. D8000 is
// there to be read and written; a host that is merely busy must not stop the PLC.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "emulator_models/fx_plc_emulator.hpp"
#include "emulator_models/machine_plant.hpp"
#include "emulator_models/machine_program.hpp"
#include "emulator_models/special_devices.hpp"

namespace emulator_models {

class ScanCycle {
 public:
  static constexpr std::chrono::milliseconds default_period{10};

  /// @param period  from the start of one scan to the start of the next; above zero
  ScanCycle(FxPlcEmulator& plc, MachineProgram& program, MachinePlant& plant,
            std::chrono::nanoseconds period = default_period) noexcept;

  /// One scan. The RUN switch is on: the first scan after construction is the first scan of RUN.
  /// @param now   never earlier than in the call before
  /// @param wall  what the calendar shows
  void scan_once(SteadyTime now, WallTime wall) noexcept;

  /// Scans until request_stop(), each scan one period after the one before. A scan that comes too late is
  /// done at once, the starts that it has missed are dropped. One thread.
  void run() noexcept;
  /// From any thread, not from a signal handler.
  void request_stop() noexcept;

  /// What the wires carry. Not while another thread scans.
  [[nodiscard]] const Terminals& terminals() const noexcept { return terminals_; }

 private:
  void serve_system(DeviceMemory& memory, SteadyTime now, WallTime wall) noexcept;
  void latch_inputs(DeviceMemory& memory) const noexcept;
  void write_outputs(const DeviceMemory& memory) noexcept;
  /// @return false when a stop was requested
  [[nodiscard]] bool wait_until(SteadyTime start);

  FxPlcEmulator& plc_;
  MachineProgram& program_;
  MachinePlant& plant_;
  std::chrono::nanoseconds period_;
  Terminals terminals_;
  RunMode mode_ = RunMode::stop;
  std::uint64_t scans_count_ = 0;
  SteadyTime power_up_{};
  std::chrono::nanoseconds last_scan_time_{0};

  std::mutex stop_mutex_;
  std::condition_variable stop_condition_;
  bool stop_requested_ = false;
};

}  // namespace emulator_models
