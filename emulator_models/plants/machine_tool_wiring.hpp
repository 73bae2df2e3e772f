// To which terminals the units of the machine tool are wired. Numbers are indices of X and Y; the comment has
// the octal name.
#pragma once

#include <cstddef>

namespace emulator_models::machine_tool {

/// Outputs of the PLC, by index of Y.
enum class Y : std::size_t {
  spindle_clockwise = 000,
  spindle_counter_clockwise = 001,
  spindle_orient = 002,
  flood_pump = 003,
  mist_valve = 004,
  hydraulic_pump = 005,
  chuck_clamp = 006,
  chuck_unclamp = 007,
  magazine_clockwise = 010,  ///< to higher pocket numbers
  magazine_counter_clockwise = 011,
  pocket_down = 012,   ///< spring returns it up
  arm_grip = 013,      ///< from home to the tools; off: back
  arm_exchange = 014,  ///< pulls both tools, swings, inserts
  tool_unclamp = 015,  ///< springs clamp
  lubrication_pump = 016,
  door_unlock = 017,  ///< without current a spring bolts the door: a PLC that stops leaves it locked
  contactor = 020,
  red_lamp = 021,
  yellow_lamp = 022,
  green_lamp = 023,
  horn = 024,
};

/// Inputs of the PLC, by index of X.
enum class X : std::size_t {
  spindle_at_speed = 000,
  spindle_zero_speed = 001,
  spindle_drive_fault = 002,
  spindle_oriented = 003,
  flood_flow = 004,
  mist_flow = 005,
  coolant_level_low = 006,
  coolant_motor_overload = 007,
  hydraulic_pressure = 010,
  chuck_clamped = 011,
  chuck_unclamped = 012,
  door_closed = 013,
  door_locked = 014,
  lubrication_pressure = 015,
  lubrication_level_low = 016,
  hydraulic_motor_overload = 017,
  pocket_pulse = 020,   ///< a pocket stands at the change position
  magazine_home = 021,  ///< it is pocket 1
  pocket_is_down = 022,
  pocket_is_up = 023,
  arm_home = 024,
  arm_gripping = 025,
  arm_exchanged = 026,  ///< until arm_exchange is off
  tool_clamped = 027,
  tool_unclamped = 030,
  tool_present = 031,
  magazine_motor_overload = 032,
  chain_closed = 033,  ///< all contacts of the emergency-stop chain
  buttons_released = 034,
  over_travel_free = 035,
  drives_ready = 036,
  contactor_on = 037,
  door_button = 040,  ///< the operator asks for the door
  reset_button = 041,
};

/// Words D210 and D200: demanded and actual speed of the spindle in 1/min.
inline constexpr std::size_t speed_order_word = 0;
inline constexpr std::size_t speed_actual_word = 0;

constexpr std::size_t index_of(Y output) noexcept { return static_cast<std::size_t>(output); }
constexpr std::size_t index_of(X input) noexcept { return static_cast<std::size_t>(input); }

}  // namespace emulator_models::machine_tool
