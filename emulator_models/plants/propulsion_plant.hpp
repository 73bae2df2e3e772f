// The marine propulsion station behind the terminals of its PLC: oil pumps, control lever, engine and shaft,
// and the hands of the people at it. propulsion_devices.hpp has the wiring.
//
// Invariants
//   I1  what advance() does depends on the outputs, the times and the setters, on nothing else.
//   I2  between two calls the plant follows the outputs of the first: it sees an output when the next scan begins.
// No allocation, no lock: one thread. Buzzer and lamps have no feedback; the outputs are what can be seen.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "emulator_models/plants/control_lever.hpp"
#include "emulator_models/plants/lubricating_oil.hpp"
#include "emulator_models/plants/propulsion_shaft.hpp"
#include "emulator_models/plants/terminals.hpp"
#include "emulator_models/special_devices.hpp"

namespace emulator_models {

enum class PropulsionFailure : std::uint8_t {
  pump_1_without_pressure,
  pump_2_without_pressure,
  pump_1_overload,
  pump_2_overload,
  pressure_switch_stuck_closed,
  pressure_switch_stuck_open,
  lever_wire_broken,
  lever_short_circuit,
  lever_noise,
  lever_servo_jammed,
  astern_switch_stuck_open,
  stop_switch_stuck_closed,
  ahead_switch_stuck_open,
  shaft_blocked,
  speed_sensor_broken,
};
inline constexpr std::size_t propulsion_failures_count = 15;

class PropulsionPlant {
 public:
  /// Reads the outputs and sets the inputs as they are at `now`.
  /// @param now  an earlier time than in the call before counts as the same
  void advance(Terminals& terminals, SteadyTime now) noexcept;

  void set_failure(PropulsionFailure failure, bool on) noexcept;
  /// @param permille  -1000 (full astern) to 1000; without effect while the servo holds the lever
  void move_lever(std::int32_t permille) noexcept { lever_.move_to(permille); }
  void press_acknowledge(bool pressed) noexcept { hands_.acknowledge = pressed; }
  void press_start(bool pressed) noexcept { hands_.start = pressed; }
  void press_stop(bool pressed) noexcept { hands_.stop = pressed; }
  void set_local_switch(bool on) noexcept { hands_.local = on; }
  void set_pumps_switch(bool on) noexcept { hands_.pumps = on; }
  /// @param permille  part of the torque that the sea takes, 0 to 900
  void set_sea_load(std::int32_t permille) noexcept { shaft_.set_sea_load(permille); }

  [[nodiscard]] bool has_oil_pressure() const noexcept { return oil_.has_pressure(); }
  [[nodiscard]] std::int32_t lever_permille() const noexcept { return lever_.position_permille(); }
  [[nodiscard]] std::int32_t shaft_permille() const noexcept { return shaft_.speed_permille(); }

 private:
  struct Hands {
    bool acknowledge = false;
    bool start = false;
    bool stop = false;
    bool local = false;
    bool pumps = false;
  };

  void set_inputs(Terminals& terminals) const noexcept;

  propulsion::LubricatingOil oil_;
  propulsion::ControlLever lever_;
  propulsion::PropulsionShaft shaft_;
  Hands hands_;
  std::optional<SteadyTime> last_;
};

}  // namespace emulator_models
