// Watches a machine tool from outside and names the interlock rules that are broken.
//
// It looks at wires, at what really moves, and at the contract between kernel and PLC, once a scan after the
// outputs were written; it knows nothing of the program. Where a rule needs a switch, the switch as wired counts:
// no program can know that it lies. A state that must end when something else happens gets `reaction` for it.
//
// No allocation per look.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <string_view>

#include "emulator_models/plants/machine_tool_plant.hpp"

namespace emulator_models {

enum class MachineToolRule : std::uint8_t {
  spindle_door,              ///< spindle on with the door open or not locked
  spindle_chuck,             ///< spindle on with the chuck open or without pressure
  directions,                ///< both directions together
  reversal_through_zero,     ///< a direction ordered while the spindle turns the other way
  coolant_off_in_time,       ///< coolant on after M9, M0, M1, M2, M30, M60, reset, emergency stop
  coolant_supervision,       ///< coolant on for more than 3 s without flow
  feed_at_speed,             ///< feed enabled while the ordered spindle is not at speed
  door_feed_hold,            ///< feed enabled with the door open
  door_unlock,               ///< unlocked while the spindle turns or an axis moves
  change_at_standstill,      ///< arm in motion or tool unclamped while the spindle turns
  change_at_position,        ///< arm in motion with Z away from the change position
  arm_and_magazine,          ///< arm and magazine moving together, or the magazine with the arm out
  chuck_at_standstill,       ///< chuck valve to open while the spindle turns
  fin_after_feedback,        ///< FIN without the feedback of its function
  no_restart_after_estop,    ///< an output on again after an emergency stop without a reset edge
  estop_drops_outputs,       ///< an output on while the chain is open
  waits_bounded,             ///< a function goes on for more than 5 s although nothing happens any more
  lubrication_supervision,   ///< a whole run without pressure and no warning
  outputs_off_when_stopped,  ///< the PLC does not run, and outputs stay on
};
inline constexpr std::size_t machine_tool_rules_count = 19;

/// As in the program's comments: "spindle-door".
[[nodiscard]] std::string_view name_of(MachineToolRule rule) noexcept;

/// The devices of the contract as they are after the scan.
struct MachineToolContract {
  std::uint16_t m_code = 0;
  std::uint16_t selected_tool = 0;   ///< D220
  std::uint16_t warning_number = 0;  ///< D121
  bool m_strobe = false;
  bool s_strobe = false;
  bool t_strobe = false;
  bool distribution_end = false;
  bool reset = false;
  bool z_at_change = false;
  bool fin = false;
  bool alarm = false;
  bool feed_enable = false;
  bool plc_runs = true;
};

class MachineToolRules {
 public:
  using Broken = std::bitset<machine_tool_rules_count>;

  /// @param reaction  two scans, and the way to the terminals
  explicit MachineToolRules(std::chrono::nanoseconds reaction = std::chrono::milliseconds{25}) noexcept
      : reaction_{reaction} {}

  /// @param now  of this scan, never decreasing
  /// @return     the rules that this look found broken, by index of MachineToolRule
  Broken look(const Terminals& terminals, const MachineToolPlant& plant, const MachineToolContract& contract,
              SteadyTime now) noexcept;

 private:
  struct View;

  /// Broken when `wrong` has held for longer than `limit`.
  void bound(MachineToolRule rule, bool wrong, std::chrono::nanoseconds limit, SteadyTime now) noexcept;
  void look_at_spindle(const View& view) noexcept;
  void look_at_coolant(const View& view) noexcept;
  void look_at_changer(const View& view) noexcept;
  void look_at_emergency_stop(const View& view) noexcept;
  void look_at_functions(const View& view) noexcept;
  [[nodiscard]] static bool has_feedback(const View& view, std::uint16_t m_code) noexcept;

  std::chrono::nanoseconds reaction_;
  Broken broken_;
  std::array<SteadyTime, machine_tool_rules_count> wrong_since_{};
  Broken wrong_;
  bool coolant_is_to_be_off_ = true;
  bool was_strobed_ = false;
  bool strobe_counts_ = false;
  std::uint16_t m_code_ = 0;
  bool was_fin_ = false;
  bool was_reset_ = true;
  bool may_be_on_ = false;
  bool pump_was_on_ = false;
  bool pressure_seen_ = false;
  SteadyTime pump_since_{};
  bool warning_is_due_ = false;
  std::bitset<Terminals::points_count> inputs_;
  std::uint16_t speed_rpm_ = 0;
  SteadyTime nothing_happens_since_{};
};

}  // namespace emulator_models
