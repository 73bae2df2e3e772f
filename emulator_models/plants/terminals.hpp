// What the wires between a PLC and its plant carry at this moment. Whoever scans fills the outputs, the plant
// fills the inputs.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace emulator_models {

struct Terminals {
  static constexpr std::size_t points_count = 256;
  static constexpr std::size_t analogs_count = 8;

  std::bitset<points_count> inputs;                           ///< X by index: X10 is 8
  std::bitset<points_count> outputs;                          ///< Y by index
  std::array<std::uint16_t, analogs_count> analog_inputs{};   ///< wired to D200 to D207
  std::array<std::uint16_t, analogs_count> analog_outputs{};  ///< wired to D210 to D217
};

/// Points as a process image has them: eight to a byte, the lowest number in bit 0.
using TerminalPoints = std::bitset<Terminals::points_count>;
static_assert(
    std::endian::native == std::endian::little && std::is_trivially_copyable_v<TerminalPoints> &&
        sizeof(TerminalPoints) == Terminals::points_count / 8,
    "points are copied as the words that the bitset consists of, the lowest first: shifting them into "
    "place would take a third of an empty scan");

/// @param image  at most 32 bytes; points beyond it are left out
inline void copy_points(const TerminalPoints& points, std::span<std::byte> image) noexcept {
  std::memcpy(image.data(), &points, std::min(image.size(), sizeof points));
}

/// @param image  at most 32 bytes; points beyond it are off
inline TerminalPoints points_of(std::span<const std::byte> image) noexcept {
  std::array<std::byte, sizeof(TerminalPoints)> bytes{};
  std::memcpy(bytes.data(), image.data(), std::min(image.size(), bytes.size()));
  return std::bit_cast<TerminalPoints>(bytes);
}

}  // namespace emulator_models
