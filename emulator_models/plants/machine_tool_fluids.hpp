// Coolant, hydraulics with the chuck, central lubrication: pumps whose effect comes a time after their order.
#pragma once

#include "emulator_models/plants/plant_motion.hpp"
#include "emulator_models/plants/terminals.hpp"

namespace emulator_models::machine_tool {

/// Flood pump and mist valve. Flow 500 ms and 300 ms after the order, gone with it. An overloaded motor stands.
class Coolant {
 public:
  static constexpr std::chrono::milliseconds flood_time{500};
  static constexpr std::chrono::milliseconds mist_time{300};

  void advance(Terminals& terminals, bool powered, SteadyTime now) noexcept;

  void set_flood_blocked(bool on) noexcept { flood_blocked_ = on; }
  void set_mist_blocked(bool on) noexcept { mist_blocked_ = on; }
  void set_level_low(bool on) noexcept { level_low_ = on; }
  void set_motor_overload(bool on) noexcept { motor_overload_ = on; }
  [[nodiscard]] bool flows() const noexcept { return flood_flows_ || mist_flows_; }

 private:
  OnDelay flood_{flood_time};
  OnDelay mist_{mist_time};
  bool flood_flows_ = false;
  bool mist_flows_ = false;
  bool flood_blocked_ = false;
  bool mist_blocked_ = false;
  bool level_low_ = false;
  bool motor_overload_ = false;
};

/// Pressure 1.5 s after the pump, gone with it. The chuck travels in 400 ms under pressure and stays where it is
/// without; its valve has two coils, and with both on it stays, too. Clamped at first.
class Hydraulics {
 public:
  static constexpr std::chrono::milliseconds pressure_time{1500};
  static constexpr std::chrono::milliseconds chuck_time{400};

  void advance(Terminals& terminals, bool powered, SteadyTime now) noexcept;

  void set_pressure_missing(bool on) noexcept { pressure_missing_ = on; }
  void set_motor_overload(bool on) noexcept { motor_overload_ = on; }
  void set_chuck_stuck(bool on) noexcept { chuck_stuck_ = on; }
  [[nodiscard]] bool chuck_is_clamped() const noexcept { return chuck_.is_back(); }

 private:
  OnDelay pressure_{pressure_time};
  Travel chuck_{chuck_time};  ///< out = unclamped
  bool pressure_missing_ = false;
  bool motor_overload_ = false;
  bool chuck_stuck_ = false;
  SteadyTime last_{};
  bool has_run_ = false;
};

/// Pressure 2 s after the pump, gone with it.
class Lubrication {
 public:
  static constexpr std::chrono::seconds pressure_time{2};

  void advance(Terminals& terminals, bool powered, SteadyTime now) noexcept;

  void set_pressure_missing(bool on) noexcept { pressure_missing_ = on; }
  void set_level_low(bool on) noexcept { level_low_ = on; }

 private:
  OnDelay pressure_{pressure_time};
  bool pressure_missing_ = false;
  bool level_low_ = false;
};

}  // namespace emulator_models::machine_tool
