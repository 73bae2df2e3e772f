// The propulsion station for tests: plant, PLC program and observer, scanned every 10 ms of simulated time, and
// the operator station, whose heartbeat goes on until it is stopped.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "emulator_models/device_memory.hpp"
#include "emulator_models/plants/propulsion_plant.hpp"
#include "emulator_models/plants/propulsion_rules.hpp"
#include "emulator_models/soft_plc/il_machine.hpp"

namespace emulator_models {

/// The program without the lines of one rule.
/// @param rule  "OIL_START"; empty: the whole program
[[nodiscard]] std::string program_without(std::string_view rule);

class PropulsionRig {
 public:
  static constexpr std::chrono::milliseconds scan_period{10};

  explicit PropulsionRig(std::string_view rule_left_out = "");

  void scan();
  void scan_for(std::chrono::milliseconds time);

  /// Pumps on, pressure there, started from the lever at zero; then a second more.
  void start();
  /// The station has control, and the heartbeat beats.
  void give_control_to_station();
  void press_acknowledge();
  void press_start();
  /// The PLC goes to STOP and back to RUN: what is not latched is lost.
  void stop_and_run_plc();
  void fail(PropulsionFailure failure, bool on = true) { plant.set_failure(failure, on); }

  [[nodiscard]] bool in(propulsion::Device x) const { return terminals.inputs.test(x.number); }
  [[nodiscard]] bool out(propulsion::Device y) const { return terminals.outputs.test(y.number); }
  [[nodiscard]] bool on(propulsion::Device m) const;
  [[nodiscard]] int word(propulsion::Device d) const;
  void set(propulsion::Device m, bool value);
  void set_word(propulsion::Device d, int value);
  /// "" or the names, each after a blank.
  [[nodiscard]] std::string broken_rules() const;

  PropulsionPlant plant;
  Terminals terminals;
  PropulsionRules rules;
  bool heartbeat = true;

 private:
  [[nodiscard]] PropulsionContract contract() const;

  soft_plc::IlProgram program_;
  std::unique_ptr<soft_plc::IlMachine> machine_;
  DeviceMemory devices_{protocol::fx::Model::fx3u};
  SteadyTime now_{std::chrono::hours{1}};
};

}  // namespace emulator_models
