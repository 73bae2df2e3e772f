// The devices that each model has: one table, which the address map, the names and the emulator's memory
// share. Source: the device tables of the FX manuals (FX3U also the MC protocol manual's).
#pragma once

#include <cstdint>

#include "protocol/fx/address_map.hpp"

namespace protocol::fx {

/// How many devices of each kind a model has, counted from number 0. Two gaps are not in these counts:
/// FX1S has the counters C0-C31 and C235-C255 only, and special M and D begin at 8000.
struct DeviceRanges {
  std::uint16_t x, y, m, s, t, c, d, special;
};

inline constexpr std::uint16_t first_special_number = 8000;
/// The first counter of 32 bit, and where the counters of an FX1S go on after their gap.
inline constexpr std::uint16_t first_wide_counter = 200;
inline constexpr std::uint16_t fx1s_first_fast_counter = 235;
inline constexpr std::uint16_t fx1s_slow_counters_count = 32;

[[nodiscard]] constexpr DeviceRanges ranges_of(Model model) noexcept {
  switch (model) {
    case Model::fx1s:
      return {.x = 16, .y = 14, .m = 512, .s = 128, .t = 64, .c = 256, .d = 256, .special = 256};
    case Model::fx1n:
      return {.x = 128, .y = 128, .m = 1536, .s = 1000, .t = 256, .c = 256, .d = 8000, .special = 256};
    case Model::fx2n:
      return {.x = 184, .y = 184, .m = 3072, .s = 1000, .t = 256, .c = 256, .d = 8000, .special = 256};
    case Model::fx3u:
      return {.x = 256, .y = 256, .m = 7680, .s = 4096, .t = 512, .c = 256, .d = 8000, .special = 512};
  }
  return {};
}

/// @return 1, 16 or 32
[[nodiscard]] constexpr unsigned width_bits_of(Device device) noexcept {
  switch (device.kind) {
    case DeviceKind::x:
    case DeviceKind::y:
    case DeviceKind::m:
    case DeviceKind::s:
    case DeviceKind::t_contact:
    case DeviceKind::c_contact:
      return 1;
    case DeviceKind::t_value:
    case DeviceKind::d:
      return 16;
    case DeviceKind::c_value:
      return device.number < first_wide_counter ? 16 : 32;
  }
  return 0;
}

}  // namespace protocol::fx
