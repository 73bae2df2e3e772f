// A PLC with its program and its machine, scanned by hand: time passes only when a test says so.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "emulator_models/fx_plc_emulator.hpp"
#include "emulator_models/machine_plant.hpp"
#include "emulator_models/machine_program.hpp"
#include "emulator_models/scan_cycle.hpp"

namespace emulator_models {

/// Writes down what it is told: "start M3", "finish S1000".
class RecordingObserver final : public MachineObserver {
 public:
  void action_started(FunctionKind kind, std::uint16_t number) noexcept override;
  void action_finished(FunctionKind kind, std::uint16_t number) noexcept override;

  std::vector<std::string> events;
};

struct MachineRig {
  FxPlcEmulator plc{protocol::fx::Model::fx3u};
  RecordingObserver observer;
  MachineProgram program{&observer};
  MachinePlant plant;
  ScanCycle scan{plc, program, plant};
  SteadyTime now{std::chrono::hours{1}};
  WallTime wall{};

  /// Scans every 10 ms for `duration`, at least once.
  void run_for(std::chrono::milliseconds duration);
  void scan_once() { run_for(std::chrono::milliseconds{10}); }
  /// Scans until the device is on.
  /// @return the time it took; the limit of 20 s when it did not come on
  std::chrono::milliseconds run_until_on(std::string_view device);

  [[nodiscard]] unsigned get(std::string_view device);
  void set(std::string_view device, unsigned value);
  /// What the wire of the output carries.
  [[nodiscard]] bool output(std::string_view device) const;
  std::vector<std::string> take_events();
};

}  // namespace emulator_models
