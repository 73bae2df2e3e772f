// What a run prints at its end.
#pragma once

#include <span>
#include <string>

#include "tests/kill_run/supervisor.hpp"

namespace kill_run {

[[nodiscard]] std::string to_text(const RunResult& result);
/// The first ones, and how many there are of each invariant.
/// @param accusations  each begins with its invariant, "I5: ..."
[[nodiscard]] std::string to_text(std::span<const std::string> accusations);

}  // namespace kill_run
