// Two lubricating-oil pumps on one pipe, and its pressure switch.
//
// Pressure builds up in 2 s while a pump delivers and falls in 1 s while none does, both evenly; the switch
// closes at full pressure and opens below half of it. Counted in integers: any steps of time add up alike.
// Left out: temperature, level, filters.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace emulator_models::propulsion {

class LubricatingOil {
 public:
  static constexpr std::size_t pumps_count = 2;
  static constexpr std::chrono::nanoseconds build_up_time = std::chrono::seconds{2};
  static constexpr std::chrono::nanoseconds fall_time = std::chrono::seconds{1};

  /// The contactors stay as they are for `elapsed`.
  void pass(std::chrono::nanoseconds elapsed) noexcept;
  /// @param ordered  whether the PLC closes the contactor; a tripped motor protection keeps it open
  void order(std::size_t pump, bool ordered) noexcept { pumps_[pump].ordered = ordered; }

  [[nodiscard]] bool runs(std::size_t pump) const noexcept {
    return pumps_[pump].ordered && !pumps_[pump].overloaded;
  }
  [[nodiscard]] bool protection_closed(std::size_t pump) const noexcept { return !pumps_[pump].overloaded; }
  [[nodiscard]] bool pressure_switch_closed() const noexcept;
  /// The truth behind the switch.
  [[nodiscard]] bool has_pressure() const noexcept { return has_pressure_; }

  void set_overloaded(std::size_t pump, bool on) noexcept { pumps_[pump].overloaded = on; }
  /// The motor turns, the pump sucks air.
  void set_without_pressure(std::size_t pump, bool on) noexcept { pumps_[pump].without_pressure = on; }
  void set_switch_stuck_closed(bool on) noexcept { stuck_closed_ = on; }
  /// Stronger than stuck closed: as a broken wire.
  void set_switch_stuck_open(bool on) noexcept { stuck_open_ = on; }

 private:
  struct Pump {
    bool ordered = false;
    bool overloaded = false;
    bool without_pressure = false;
  };

  std::array<Pump, pumps_count> pumps_{};
  /// How long a pump would have had to deliver to build it up from nothing.
  std::chrono::nanoseconds pressure_{0};
  bool has_pressure_ = false;
  bool stuck_closed_ = false;
  bool stuck_open_ = false;
};

}  // namespace emulator_models::propulsion
