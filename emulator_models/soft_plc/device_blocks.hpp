// Timers and counters of a PLC whose contact and current value are devices of its memory: others read and write
// them there, and the block goes on from what it finds.
//
// Only a call looks at time and edges, as the coil instruction of an FX does. Contact := current value >= PV, in each
// call.
//
// Invariants
//   I1  a timer counts whole units: the rest of a unit is kept from call to call and never rounded up.
//   I2  a timer's value stays at PV (0 to 32767) once it is there; time it has not been called counts with the next
//       call, if IN was on before.
//   I3  a 16-bit counter stays at PV; one of 32 bits counts on, both ways, and wraps.
//   I4  R wins: value 0, contact off, edges in that call lost.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace emulator_models::soft_plc {

struct BitDevice {
  std::uint32_t byte_index = 0;
  std::uint8_t bit_index = 0;
};

/// The parts of a block that lie in the PLC's memory, and its unit.
struct BlockDevices {
  BitDevice contact;
  std::uint32_t value_byte_index = 0;
  BitDevice counts_down;              ///< of a 32-bit counter: on = down
  std::chrono::milliseconds unit{0};  ///< of a timer
};

struct DeviceTimer {
  bool in = false;
  bool r = false;  ///< of a retentive timer
  std::int16_t pv = 0;
  bool was_on = false;
  std::chrono::nanoseconds last_call{0};
  std::chrono::nanoseconds rest{0};
  BlockDevices devices;

  /// IN off clears value and contact.
  void call(std::byte* memory, std::chrono::nanoseconds now) noexcept;
  /// IN off keeps both; R clears them.
  void call_retentive(std::byte* memory, std::chrono::nanoseconds now) noexcept;
};

/// 16 bits, up.
struct DeviceCounter {
  bool cu = false;
  bool r = false;
  std::int16_t pv = 0;
  bool was_on = false;
  BlockDevices devices;

  void call(std::byte* memory) noexcept;
};

/// 32 bits, up or down.
struct WideDeviceCounter {
  bool cu = false;
  bool r = false;
  bool was_on = false;
  std::int32_t pv = 0;
  BlockDevices devices;

  void call(std::byte* memory) noexcept;
};

}  // namespace emulator_models::soft_plc
