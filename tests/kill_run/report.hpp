// What a run prints at its end.
#pragma once

#include <string>

#include "tests/kill_run/supervisor.hpp"

namespace kill_run {

[[nodiscard]] std::string to_text(const RunResult& result);

}  // namespace kill_run
