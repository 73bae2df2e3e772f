// What tasks wait for that wait for a numbered thing of the world.
#pragma once

#include <cstdint>

#include "sim_clock/world/task.hpp"

namespace ltsim {

/// @param shared  between processes; what is not wakes and is waited for by tasks of the running one's process only
[[nodiscard]] inline WaitKey object_key(ObjectId object, bool shared) noexcept {
  const std::uint64_t process = shared ? 0 : current_task->process + 1U;
  return std::uint64_t{1} << 62U | process << 32U | object;
}

}  // namespace ltsim
