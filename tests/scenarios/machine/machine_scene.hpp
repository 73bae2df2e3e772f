// A shift at the machine tool: part programs drawn at random, an operator who presses buttons, a machine that
// fails; on the whole kernel and the whole emulator, over the published handoff.
#pragma once

#include "emulator_models/soft_plc/il_program.hpp"
#include "sim_clock/world/world.hpp"
#include "tests/scenarios/machine/watched_machine.hpp"

namespace scenarios {

enum class FinWait { until_low, none };

/// @param program   of the PLC, compiled for an FX3U
/// @param fin_wait  none: the kernel takes FIN for low as soon as it has let its strobes fall
void run_shift(ltsim::World& world, const emulator_models::soft_plc::IlProgram& program,
               PortService service = PortService::at_scan_boundary, FinWait fin_wait = FinWait::until_low);

}  // namespace scenarios
