// What scenarios of whole programs share, one program alone or several as processes of one world.
#pragma once

#include <string>
#include <vector>

#include "sim_clock/program/output_capture.hpp"
#include "sim_clock/scenario/scenario.hpp"

namespace ltsim {

/// What a parent gets to know of an exit status.
inline constexpr int exit_status_mask = 0xff;

/// World::run(); what the programs write meanwhile becomes World::output().
void run_captured(World& world, OutputCapture& capture);

/// Runs the command line of ltsim over the scenario alone.
/// @param scenario  its name and description outlive the call
/// @param command   e.g. {"ltsim", "explore", "--seed", "2", "bank"}
/// @return          the exit code
[[nodiscard]] int run_program_command(Scenario scenario, const std::vector<std::string>& command);

}  // namespace ltsim
