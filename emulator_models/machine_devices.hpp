// Which device of the PLC is what in the built-in machine: the contract with the kernel (README.md has it as
// a table), the terminals to which the machine is wired, and the words that the program keeps for itself.
#pragma once

#include "protocol/fx/address_map.hpp"

namespace emulator_models::machine {

using protocol::fx::Device;
using protocol::fx::DeviceKind;

// Kernel to PLC.
inline constexpr Device m_code{DeviceKind::d, 100};
inline constexpr Device s_value{DeviceKind::d, 101};
inline constexpr Device t_number{DeviceKind::d, 102};
inline constexpr Device m_strobe{DeviceKind::m, 100};
inline constexpr Device s_strobe{DeviceKind::m, 101};
inline constexpr Device t_strobe{DeviceKind::m, 102};
inline constexpr Device distribution_end{DeviceKind::m, 103};
inline constexpr Device program_running{DeviceKind::m, 104};
inline constexpr Device reset{DeviceKind::m, 105};
inline constexpr Device feed_hold_active{DeviceKind::m, 106};

// PLC to kernel.
inline constexpr Device fin{DeviceKind::m, 120};
inline constexpr Device alarm{DeviceKind::m, 121};
inline constexpr Device emergency_stop_ok{DeviceKind::m, 122};
inline constexpr Device spindle_at_speed{DeviceKind::m, 123};
inline constexpr Device door_closed{DeviceKind::m, 124};
inline constexpr Device feed_enable{DeviceKind::m, 125};
inline constexpr Device cycle_start_enable{DeviceKind::m, 126};
inline constexpr Device alarm_number{DeviceKind::d, 120};

// The program's own words.
inline constexpr Device selected_tool{DeviceKind::d, 110};
inline constexpr Device tool_in_spindle{DeviceKind::d, 111};
/// Speed demanded of the spindle drive, 1/min: stands for an analog output.
inline constexpr Device spindle_speed{DeviceKind::d, 112};

// Outputs. Numbers are indices: 8 is Y10.
inline constexpr Device spindle_clockwise{DeviceKind::y, 0};
inline constexpr Device spindle_counter_clockwise{DeviceKind::y, 1};
inline constexpr Device flood_coolant{DeviceKind::y, 2};
inline constexpr Device mist_coolant{DeviceKind::y, 3};
inline constexpr Device tool_magazine{DeviceKind::y, 4};
inline constexpr Device tool_clamp_release{DeviceKind::y, 5};
inline constexpr Device green_lamp{DeviceKind::y, 8};
inline constexpr Device yellow_lamp{DeviceKind::y, 9};
inline constexpr Device red_lamp{DeviceKind::y, 10};

// Inputs.
inline constexpr Device at_speed_switch{DeviceKind::x, 0};
inline constexpr Device zero_speed_switch{DeviceKind::x, 1};
inline constexpr Device flood_flow_switch{DeviceKind::x, 2};
inline constexpr Device mist_flow_switch{DeviceKind::x, 3};
inline constexpr Device tool_changed_switch{DeviceKind::x, 4};
inline constexpr Device door_switch{DeviceKind::x, 5};
inline constexpr Device emergency_stop_chain{DeviceKind::x, 6};

}  // namespace emulator_models::machine
