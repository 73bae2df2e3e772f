// Guard door and emergency-stop chain.
#pragma once

#include "emulator_models/plants/plant_motion.hpp"
#include "emulator_models/plants/terminals.hpp"

namespace emulator_models::machine_tool {

/// The solenoid draws the bolt back in 100 ms, a spring pushes it out as fast, into a closed door only; a locked door stays closed whatever
/// the operator does. A broken lock neither holds nor reports.
class GuardDoor {
 public:
  static constexpr std::chrono::milliseconds lock_time{100};

  void advance(Terminals& terminals, SteadyTime now) noexcept;

  void set_pulled_open(bool pulled) noexcept { pulled_open_ = pulled; }
  void set_lock_broken(bool broken) noexcept { lock_broken_ = broken; }
  [[nodiscard]] bool is_open() const noexcept { return open_; }

 private:
  Travel bolt_{lock_time};  ///< out = locked
  bool open_ = false;
  bool pulled_open_ = false;
  bool lock_broken_ = false;
  SteadyTime last_{};
  bool has_run_ = false;
};

/// Contacts in series, and the contactor that gives all motors and valves their power: it picks up 50 ms after its
/// order, and an open contact drops it at once, whatever the PLC does.
class EmergencyStop {
 public:
  static constexpr std::chrono::milliseconds contactor_time{50};

  /// @return whether there is power
  bool advance(Terminals& terminals, SteadyTime now) noexcept;

  void set_button_pressed(bool pressed) noexcept { button_pressed_ = pressed; }
  void set_over_travel(bool on) noexcept { over_travel_ = on; }
  void set_drives_not_ready(bool on) noexcept { drives_not_ready_ = on; }

 private:
  OnDelay contactor_{contactor_time};
  bool button_pressed_ = false;
  bool over_travel_ = false;
  bool drives_not_ready_ = false;
};

}  // namespace emulator_models::machine_tool
