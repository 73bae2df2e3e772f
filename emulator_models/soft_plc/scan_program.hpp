// What a cycle does in a scan, seen from both sides: the step that the scan task orders, and the interface by
// which the PLC behind it carries it out.
#pragma once

#include <chrono>
#include <cstdint>

namespace emulator_models::soft_plc {

enum class ScanAction : std::uint8_t {
  system_analysis,       ///< phase 1: requests of the ports, RUN and STOP, system parameters
  clear_fault,           ///< after a reset
  initialise,            ///< before the first scan of RUN
  write_safe_outputs,    ///< on the change from RUN to STOP
  read_inputs,           ///< phase 2: into the image, which then stays as it is
  read_from_cycles,      ///< phase 3: what other cycles have sent
  execute,               ///< phase 4: one slice of the program
  write_to_cycles,       ///< phase 5: what other cycles are to receive
  write_outputs,         ///< phase 6: image refreshed, all terminals written together
  refresh_output_image,  ///< phase 6 in STOP: image refreshed, terminals left alone
  wait,                  ///< phase 7
  enter_fault,           ///< instead of what was left of the scan
};

/// Cold: all variables get their initial values. Warm: those marked RETAIN keep theirs.
enum class StartKind : std::uint8_t { cold, warm };

enum class Progress : std::uint8_t {
  finished,
  unfinished,  ///< the same step is to be ordered again
  failed,      ///< a run-time fault; its place is known to whoever reports it
};

struct ScanStep {
  ScanAction action = ScanAction::wait;
  /// wait: when the next scan is due, which may have passed. All others: the last moment at which the scan is
  /// still normal for the watchdog.
  std::chrono::nanoseconds until{0};
  /// When the scan began: the one time that all function blocks of this scan see.
  std::chrono::nanoseconds scan_start{0};
  bool first_scan = false;
  StartKind start = StartKind::cold;  ///< of the latest start of RUN
};

/// Implemented by the PLC. A call does its work and comes back: the watchdog cannot look in between.
class ScanProgram {
 public:
  virtual ~ScanProgram() = default;

  virtual void system_analysis() noexcept = 0;
  virtual void initialise(StartKind start) noexcept = 0;
  virtual void read_inputs() noexcept = 0;
  virtual void read_from_cycles() noexcept = 0;
  /// One slice of the program: a bounded piece, so that an endless loop shows as `unfinished` for ever.
  virtual Progress execute(const ScanStep& step) noexcept = 0;
  virtual void write_to_cycles() noexcept = 0;
  virtual void refresh_output_image() noexcept = 0;
  virtual void write_outputs() noexcept = 0;
  /// All outputs but the alarm lamp; the output image stays as it is, for whoever looks for the reason. What
  /// the program had got to in this scan is given up: the next `execute` begins at its first instruction.
  virtual void write_safe_outputs() noexcept = 0;
  virtual void set_alarm_lamp(bool on) noexcept = 0;

 protected:
  ScanProgram() = default;
  ScanProgram(const ScanProgram&) = default;
  ScanProgram& operator=(const ScanProgram&) = default;
};

/// Carries out one step. Nothing is done for wait: sleeping is up to the caller.
/// @return finished for all but execute
Progress perform(const ScanStep& step, ScanProgram& program) noexcept;

}  // namespace emulator_models::soft_plc
