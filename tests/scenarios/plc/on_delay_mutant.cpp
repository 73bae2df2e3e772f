// The on-delay timer from the soft PLC's own source, but that its elapsed time wraps (CMakeLists.txt).

#include "emulator_models/soft_plc/function_blocks.hpp"
#include "tests/scenarios/plc/on_delay_scene.hpp"

namespace scenarios {

void watch_wrapping_on_delay(ltsim::World& world) { watch_on_delay<emulator_models::soft_plc::Ton>(world); }

}  // namespace scenarios
