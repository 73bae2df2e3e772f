// The drivers that a configured soft PLC may name: a simulated field, and the plants of plants/.
//
//   "simulated"      inputs are the outputs of the same numbers, or `fixed_inputs`
//   "machine-tool"   a plant behind the terminals: byte i of the driver's section has X 8i and up, the same byte of %Q
//   "propulsion"     has Y; from byte 32 on lie eight analog words each way. What a section does not reach is not wired
//
// Plants run in real time, on the driver's thread.
#pragma once

#include <memory>

#include "emulator_models/soft_plc/plc_configuration.hpp"

namespace emulator_models {

/// Byte of a plant's section at which its analog words begin: 256 terminals lie before it.
inline constexpr std::size_t plant_analogs_first_byte = 32;

/// A DriverFactory (soft_plc/configured_plc.hpp).
/// @return nullptr: there is no such kind
[[nodiscard]] std::unique_ptr<soft_plc::IoDriver> make_driver(const soft_plc::ConfiguredDriver& driver);

}  // namespace emulator_models
