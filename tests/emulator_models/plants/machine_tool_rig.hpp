// The machine tool with its program, scanned by hand, watched by the rules, and worked by a kernel that a test
// plays function by function.
#pragma once

#include <chrono>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "emulator_models/device_memory.hpp"
#include "emulator_models/plants/machine_tool_rules.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"
#include "emulator_models/soft_plc/il_machine.hpp"

namespace emulator_models {

class MachineToolRig {
 public:
  explicit MachineToolRig(std::string_view source,
                          std::chrono::nanoseconds period = std::chrono::milliseconds{10});

  MachineToolPlant plant;
  Terminals terminals;

  /// Scans until `duration` has passed, once at least.
  void run_for(std::chrono::nanoseconds duration);
  void scan();
  /// Reset for 100 ms, then hydraulics and lubrication get their time.
  void switch_on();
  void reset();

  void give(int m_code);
  void give_s(int speed);
  void give_t(int tool);
  void take_back_strobes();
  /// A whole handshake. @return the time until FIN, or 30 s when it did not come
  std::chrono::milliseconds execute(int m_code);
  std::chrono::milliseconds select_tool(int tool);
  std::chrono::milliseconds set_speed(int speed);

  [[nodiscard]] bool m(std::uint16_t number) const;
  void set_m(std::uint16_t number, bool on);
  [[nodiscard]] int d(std::uint16_t number) const;
  void set_d(std::uint16_t number, int value);
  [[nodiscard]] bool on(machine_tool::Y output) const { return terminals.outputs.test(index_of(output)); }
  [[nodiscard]] bool on(machine_tool::X input) const { return terminals.inputs.test(index_of(input)); }
  [[nodiscard]] int alarm() const { return d(120); }
  /// Whether nothing that moves is ordered; the hydraulic pump, the contactor, the lamps may be on.
  [[nodiscard]] bool moves_nothing() const;
  /// A new PLC on the same machine, its memory kept.
  void restart();

  std::set<std::string> broken;  ///< rules, by name
  std::uint64_t instructions_of_last_scan = 0;
  SteadyTime now{std::chrono::hours{1}};

 private:
  std::chrono::milliseconds wait_for_fin();

  soft_plc::IlProgram program_;
  soft_plc::IlMachine machine_;
  std::chrono::nanoseconds period_;
  MachineToolRules rules_;
  DeviceMemory devices_{protocol::fx::Model::fx3u};
};

}  // namespace emulator_models
