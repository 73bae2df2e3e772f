// The special devices (M8000, D8000 and up) that the PLC itself writes, and those by which it is told to run
// or stop.
//
// The functions change a DeviceMemory and keep nothing; who calls them holds the lock. Numbers and meanings:
// FX manuals; values of D8001 and D8101 as captured from an FX1S, an FX1N and an FX3U-compatible unit.
#pragma once

#include <chrono>
#include <cstdint>

#include "emulator_models/device_memory.hpp"

namespace emulator_models {

using SteadyTime = std::chrono::steady_clock::time_point;
using WallTime = std::chrono::system_clock::time_point;

/// D8000: the longest scan, in ms.
inline constexpr protocol::fx::Device watchdog_time{protocol::fx::DeviceKind::d, 8000};

/// M8039 on: a scan begins every D8039 ms.
inline constexpr protocol::fx::Device constant_scan{protocol::fx::DeviceKind::m, 8039};
inline constexpr protocol::fx::Device constant_scan_time{protocol::fx::DeviceKind::d, 8039};

enum class RunMode : std::uint8_t { stop, first_run_scan, run };

/// D8062: what went wrong on the programming port.
enum class PortTrouble : std::uint16_t {
  bad_character = 6202,
  bad_checksum = 6203,
  bad_format = 6204,
  bad_command = 6205,
};

/// The memory as it is after switching on: model and version, watchdog time, mode STOP.
void set_power_up_values(DeviceMemory& memory) noexcept;

/// M8000 (on in RUN), M8001 (its inverse), M8002 (on in the first scan of RUN), M8003 (its inverse). Read as
/// a byte: 0AH in STOP, 05H in the first scan, 09H in RUN.
void set_run_flags(DeviceMemory& memory, RunMode mode) noexcept;

/// They change at multiples of this only.
inline constexpr std::chrono::milliseconds clock_flags_step{5};
/// M8011 to M8014: square waves of 10 ms, 100 ms, 1 s and 1 min; off in the first half of each period.
/// @param since_power_up  not negative
void set_clock_flags(DeviceMemory& memory, std::chrono::nanoseconds since_power_up) noexcept;

/// D8013 to D8019: second, minute, hour, day, month, year (four digits), weekday (0 = Sunday), in UTC.
void set_calendar(DeviceMemory& memory, WallTime now) noexcept;

/// M8062 on, D8062 = the trouble; both stay until somebody clears them.
void note_port_trouble(DeviceMemory& memory, PortTrouble trouble) noexcept;

/// Evaluates M8035 and M8036 (both on: RUN) and M8037 (on: STOP, which wins). A stop clears all three, so
/// that the next order finds them off.
/// @return whether the PLC is to run from now on
[[nodiscard]] bool obey_remote_switch(DeviceMemory& memory, bool running) noexcept;

/// Devices that only the PLC itself writes: M8000-M8003, M8011-M8014, D8001, D8010-D8019; D8101 on an FX3U.
[[nodiscard]] bool is_read_only(protocol::fx::Device device, protocol::fx::Model model) noexcept;

}  // namespace emulator_models
