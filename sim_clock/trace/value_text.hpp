// What an access to memory has found or left there, for people.
#pragma once

#include <cstdint>
#include <string>

#include "sim_clock/world/operation.hpp"

namespace ltsim {

class World;

/// A number; of a whole program's memory, what is an address is told as one, for those differ from build to build: "&heap.main-3[8]",
/// "&ledger", "an address".
[[nodiscard]] std::string value_text(const World& world, const Operation& operation, std::uint64_t value);

}  // namespace ltsim
