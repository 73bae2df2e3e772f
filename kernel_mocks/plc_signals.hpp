// The devices through which the kernel and the PLC program talk. The PLC program is written against exactly
// these (README.md, "Signals").
#pragma once

#include <cstddef>
#include <cstdint>

#include "protocol/fx/address_map.hpp"

namespace kernel_mocks::signals {

using protocol::fx::Device;
using protocol::fx::DeviceKind;

// Kernel to PLC.
inline constexpr Device m_code{DeviceKind::d, 100};  ///< S and T follow in the next two words
/// First bit of the byte that holds the strobes: M96 to M99 are the kernel's too, and always off.
inline constexpr Device strobe_byte{DeviceKind::m, 96};
inline constexpr std::byte strobe_m{0x10};          ///< MF, M100
inline constexpr std::byte strobe_s{0x20};          ///< SF, M101
inline constexpr std::byte strobe_t{0x40};          ///< TF, M102
inline constexpr std::byte distribution_end{0x80};  ///< DEN, M103: no motion of the block is under way
inline constexpr Device program_running{DeviceKind::m, 104};
inline constexpr Device reset{DeviceKind::m, 105};
inline constexpr Device feed_hold_active{DeviceKind::m, 106};
inline constexpr Device at_tool_change_position{DeviceKind::m, 107};  ///< the Z axis
// The PLC's own: remote RUN and STOP.
inline constexpr Device plc_forced_mode{DeviceKind::m, 8035};
inline constexpr Device plc_forced_run{DeviceKind::m, 8036};
inline constexpr Device plc_forced_stop{DeviceKind::m, 8037};

// PLC to kernel.
/// First bit of the byte M120 to M127.
inline constexpr Device status_byte{DeviceKind::m, 120};
inline constexpr std::byte fin{0x01};                 ///< M120
inline constexpr std::byte alarm{0x02};               ///< M121
inline constexpr std::byte emergency_stop_ok{0x04};   ///< M122
inline constexpr std::byte spindle_at_speed{0x08};    ///< M123
inline constexpr std::byte door_closed{0x10};         ///< M124
inline constexpr std::byte feed_enable{0x20};         ///< M125
inline constexpr std::byte cycle_start_enable{0x40};  ///< M126
inline constexpr Device alarm_number{DeviceKind::d, 120};

}  // namespace kernel_mocks::signals
