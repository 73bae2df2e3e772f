// What the wires between a PLC and its plant carry at this moment. Whoever scans fills the outputs, the plant
// fills the inputs.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>

namespace emulator_models {

struct Terminals {
  static constexpr std::size_t points_count = 256;
  static constexpr std::size_t analogs_count = 8;

  std::bitset<points_count> inputs;                           ///< X by index: X10 is 8
  std::bitset<points_count> outputs;                          ///< Y by index
  std::array<std::uint16_t, analogs_count> analog_inputs{};   ///< wired to D200 to D207
  std::array<std::uint16_t, analogs_count> analog_outputs{};  ///< wired to D210 to D217
};

}  // namespace emulator_models
