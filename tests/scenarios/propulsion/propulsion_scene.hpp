// A watch at the propulsion station: people at lever, buttons and switches, a PC that polls and orders over the
// published handoff, a sea, a plant that fails; on the whole emulator.
#pragma once

#include <string_view>

#include "emulator_models/soft_plc/il_program.hpp"
#include "sim_clock/world/world.hpp"

namespace scenarios {

/// @param program    of the PLC, compiled for an FX3U
/// @param only_rule  the rule to judge by; empty: all
void keep_watch(ltsim::World& world, const emulator_models::soft_plc::IlProgram& program,
                std::string_view only_rule = {});

}  // namespace scenarios
