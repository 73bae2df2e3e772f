// A data race, told to a person.
#pragma once

#include <string>

#include "sim_clock/check/race_detector.hpp"

namespace ltsim {

class World;

/// "emulator/main writes segment.request[2] at protocol/x.cpp:40 while kernel/main reads it at
/// protocol/y.cpp:12, and nothing orders the two". The same in every process that runs this program.
[[nodiscard]] std::string describe(const Race& race, const World& world);

}  // namespace ltsim
