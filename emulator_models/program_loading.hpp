// The program that plc-emulator runs: from a file, or the one that belongs to the plant.
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "emulator_models/plant_choice.hpp"
#include "emulator_models/soft_plc/il_program.hpp"
#include "protocol/fx/address_map.hpp"

namespace emulator_models {

struct LoadedProgram {
  std::string name;  ///< of the file, as it was given
  soft_plc::IlProgram program;
};

/// @param path  empty: the plant's own program
/// @return      it, compiled for the devices of the model; or "FILE:line:column: what is wrong"
[[nodiscard]] tl::expected<LoadedProgram, std::string> load_program(const std::string& path, PlantKind plant,
                                                                    protocol::fx::Model model);

}  // namespace emulator_models
