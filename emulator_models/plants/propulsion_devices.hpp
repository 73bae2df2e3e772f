// Which device of the PLC is what in the propulsion station: the terminals to which the plant is wired, and
// the contract with the operator station, whose PC reads and writes them by their addresses. propulsion.md has
// both as tables. Numbers of X and Y are indices: 8 is X10.
#pragma once

#include <cstddef>
#include <cstdint>

#include "protocol/fx/address_map.hpp"

namespace emulator_models::propulsion {

using protocol::fx::Device;
using protocol::fx::DeviceKind;

// Inputs. Of those called closed, the contact opens when the thing happens: a broken wire is seen as trouble.
inline constexpr Device lever_astern{DeviceKind::x, 0};
inline constexpr Device lever_stop{DeviceKind::x, 1};
inline constexpr Device lever_ahead{DeviceKind::x, 2};
inline constexpr Device oil_pressure{DeviceKind::x, 3};  ///< closed: there is pressure
inline constexpr Device pump_1_runs{DeviceKind::x, 4};
inline constexpr Device pump_2_runs{DeviceKind::x, 5};
inline constexpr Device pump_1_protection{DeviceKind::x, 6};  ///< closed: not tripped
inline constexpr Device pump_2_protection{DeviceKind::x, 7};
inline constexpr Device acknowledge_button{DeviceKind::x, 8};
inline constexpr Device local_switch{DeviceKind::x, 9};
inline constexpr Device start_button{DeviceKind::x, 10};
inline constexpr Device stop_button{DeviceKind::x, 11};  ///< closed: not pressed
inline constexpr Device pumps_switch{DeviceKind::x, 12};

// Outputs.
inline constexpr Device pump_1{DeviceKind::y, 0};
inline constexpr Device pump_2{DeviceKind::y, 1};
inline constexpr Device run{DeviceKind::y, 2};
inline constexpr Device lever_servo{DeviceKind::y, 5};
inline constexpr Device buzzer{DeviceKind::y, 8};
inline constexpr Device oil_lamp{DeviceKind::y, 9};
inline constexpr Device link_lamp{DeviceKind::y, 10};
inline constexpr Device lever_lamp{DeviceKind::y, 11};
inline constexpr Device pump_lamp{DeviceKind::y, 12};
inline constexpr Device run_lamp{DeviceKind::y, 13};
inline constexpr Device local_lamp{DeviceKind::y, 14};
inline constexpr Device limit_lamp{DeviceKind::y, 15};

// Analog words, by index in Terminals. Lever: 0.01 mA of a 4 to 20 mA loop. Speed, torque: 0.1 %, signed.
inline constexpr std::size_t lever_input = 0;
inline constexpr std::size_t speed_input = 1;
inline constexpr std::size_t torque_output = 0;
inline constexpr std::size_t lever_order_output = 1;
inline constexpr Device lever_word{DeviceKind::d, 200};
inline constexpr Device speed_word{DeviceKind::d, 201};
inline constexpr Device torque_word{DeviceKind::d, 210};
inline constexpr Device lever_order_word{DeviceKind::d, 211};

// Operator station to PLC.
inline constexpr Device pc_start{DeviceKind::m, 100};
inline constexpr Device pc_stop{DeviceKind::m, 101};
inline constexpr Device pc_acknowledge{DeviceKind::m, 102};
inline constexpr Device pc_remote{DeviceKind::m, 103};
inline constexpr Device duty_is_pump_2{DeviceKind::m, 104};
inline constexpr Device pc_pumps{DeviceKind::m, 105};
inline constexpr Device pc_heartbeat{DeviceKind::d, 100};
inline constexpr Device pc_order{DeviceKind::d, 101};

// PLC to operator station.
inline constexpr Device ready{DeviceKind::m, 120};
inline constexpr Device running{DeviceKind::m, 121};
inline constexpr Device alarm{DeviceKind::m, 122};
inline constexpr Device remote{DeviceKind::m, 123};
inline constexpr Device link_lost{DeviceKind::m, 124};
inline constexpr Device speed_limited{DeviceKind::m, 125};
inline constexpr Device standby_on{DeviceKind::m, 126};
inline constexpr Device tripped{DeviceKind::m, 127};
inline constexpr Device oil_alarm{DeviceKind::m, 130};
inline constexpr Device pump_1_alarm{DeviceKind::m, 131};
inline constexpr Device pump_2_alarm{DeviceKind::m, 132};
inline constexpr Device lever_alarm{DeviceKind::m, 133};
inline constexpr Device link_alarm{DeviceKind::m, 134};
inline constexpr Device blocked_alarm{DeviceKind::m, 135};
inline constexpr Device switch_alarm{DeviceKind::m, 136};
inline constexpr Device mismatch_alarm{DeviceKind::m, 137};
inline constexpr Device speed_alarm{DeviceKind::m, 138};
inline constexpr Device lever{DeviceKind::d, 120};
inline constexpr Device setpoint{DeviceKind::d, 121};
inline constexpr Device speed{DeviceKind::d, 122};
inline constexpr Device torque{DeviceKind::d, 123};
inline constexpr Device alarm_number{DeviceKind::d, 124};
inline constexpr Device heartbeat{DeviceKind::d, 125};
inline constexpr Device target{DeviceKind::d, 130};
inline constexpr Device integral{DeviceKind::d, 131};
inline constexpr Device unlimited{DeviceKind::d, 132};

/// Everything of the shaft and the lever is counted in 0.1 %.
inline constexpr std::int32_t full_permille = 1000;

}  // namespace emulator_models::propulsion
