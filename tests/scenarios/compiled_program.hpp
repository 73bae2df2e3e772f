// PLC programs of scenarios.
#pragma once

#include <string_view>

#include "emulator_models/soft_plc/il_program.hpp"

namespace scenarios {

/// @param source  that compiles, or std::runtime_error says why not
[[nodiscard]] emulator_models::soft_plc::IlProgram compiled_for_fx3u(std::string_view source);

}  // namespace scenarios
