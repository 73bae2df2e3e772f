// What the wires between a PLC and a plant carry at one moment. A plain value that the scan and the plant
// hand to each other: the PLC sets outputs, the plant sets inputs.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>

namespace emulator_models {

struct Terminals {
  static constexpr std::size_t points_count = 256;
  static constexpr std::size_t words_count = 8;

  std::bitset<points_count> inputs;   ///< X by index: X10 is 8
  std::bitset<points_count> outputs;  ///< Y by index
  /// Wired to D200 to D207 and D210 to D217. Signed values as two's complement.
  std::array<std::uint16_t, words_count> analog_inputs{};
  std::array<std::uint16_t, words_count> analog_outputs{};
};

}  // namespace emulator_models
