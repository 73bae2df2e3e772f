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
static_assert(std::endian::native == std::endian::little, "words of points are copied as bytes");

/// @param image  at most 32 bytes; points beyond it are left out
inline void copy_points(const TerminalPoints& points, std::span<std::byte> image) noexcept {
  constexpr TerminalPoints word{~std::uint64_t{0}};
  for (std::size_t first = 0; first < image.size(); first += 8) {
    const std::uint64_t bits = ((points >> 8 * first) & word).to_ullong();
    std::memcpy(image.data() + first, &bits, std::min<std::size_t>(8, image.size() - first));
  }
}

/// @param image  at most 32 bytes; points beyond it are off
inline TerminalPoints points_of(std::span<const std::byte> image) noexcept {
  TerminalPoints points;
  for (std::size_t first = 0; first < image.size(); first += 8) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, image.data() + first, std::min<std::size_t>(8, image.size() - first));
    points |= TerminalPoints{bits} << 8 * first;
  }
  return points;
}

}  // namespace emulator_models
