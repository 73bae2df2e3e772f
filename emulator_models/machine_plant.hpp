// The machine behind the terminals: what the spindle, the coolant and the tool changer make of the outputs,
// and what the switches then report. Times are in the range of real machines.
//
//   Y0, Y1        spindle           X0 at speed 500 ms after a start or a change of speed,
//                                   X1 standing 500 ms after the stop; both outputs on: neither
//   Y2, Y3        coolant           X2, X3 flow 300 ms after the valve opens, gone when it closes
//   Y4 with Y5    tool changer      X4 tool changed after 1.2 s, until one of the two is off
//                                   X5 door closed, X6 emergency-stop chain closed
//
// Left out: faults of the drives, levels, pressures, the position of the magazine.
#pragma once

#include <cstdint>
#include <optional>

#include "emulator_models/plants/terminals.hpp"
#include "emulator_models/special_devices.hpp"

namespace emulator_models {

class MachinePlant {
 public:
  static constexpr std::chrono::milliseconds spindle_time{500};
  static constexpr std::chrono::milliseconds coolant_time{300};
  static constexpr std::chrono::milliseconds tool_change_time{1200};

  /// Reads the outputs and sets the inputs as they are at `now`.
  /// @param now  never earlier than in the call before
  void advance(Terminals& terminals, SteadyTime now) noexcept;

  void set_door_closed(bool closed) noexcept { door_closed_ = closed; }
  void set_emergency_stop_pressed(bool pressed) noexcept { emergency_stop_pressed_ = pressed; }
  /// A pipe that is blocked never shows flow.
  void set_coolant_blocked(bool blocked) noexcept { coolant_blocked_ = blocked; }

 private:
  /// On once its condition has held for a time.
  class OnDelay {
   public:
    explicit OnDelay(std::chrono::nanoseconds delay) noexcept : delay_{delay} {}
    bool update(bool condition, SteadyTime now) noexcept;

   private:
    std::chrono::nanoseconds delay_;
    std::optional<SteadyTime> since_;
  };

  struct SpindleOrder {
    bool clockwise = false;
    bool counter_clockwise = false;
    std::uint16_t speed_rpm = 0;

    bool operator==(const SpindleOrder&) const = default;
  };

  void advance_spindle(Terminals& terminals, SteadyTime now) noexcept;

  SpindleOrder spindle_order_;
  /// When the order changed; nothing before the first change: the spindle has been standing for long.
  std::optional<SteadyTime> spindle_order_since_;
  OnDelay flood_flow_{coolant_time};
  OnDelay mist_flow_{coolant_time};
  OnDelay tool_changed_{tool_change_time};
  bool door_closed_ = true;
  bool emergency_stop_pressed_ = false;
  bool coolant_blocked_ = false;
};

}  // namespace emulator_models
