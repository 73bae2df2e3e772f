// What a fuzz program's command line may say besides what the engine reads of it. The engine passes over words that begin with
// "--".
#pragma once

#include <span>

#include "sim_clock/scenario/fuzz_target.hpp"

namespace fuzz {

/// A schedule on the command line stands for the input in it: the engine gets that in a file of its own.
void replace_schedules_by_inputs(std::span<char*> arguments);

/// For a target whose bytes steer a scenario:
///   --scenario=NAME   steers that one in place of the target's own
///   --schedule=FILE   and one input: writes what it chooses to FILE, as a small schedule, and ends the program
///   FILE.schedule     is replayed, and ends the program: by abort() if it fails
void obey_scenario_arguments(const ltsim::FuzzTarget& target, std::span<char*> arguments);

}  // namespace fuzz
