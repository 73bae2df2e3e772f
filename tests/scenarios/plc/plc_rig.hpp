// Runs a scene over the soft PLC. Compiled once for each mutant of it: the namespace soft_plc then has the mutant's name.
#pragma once

#include "tests/scenarios/plc/plc_scene.hpp"

namespace scenarios::soft_plc {

void run_scene(ltsim::World& world, const PlcScene& scene);

}  // namespace scenarios::soft_plc
