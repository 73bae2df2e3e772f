// Which processors the simulated machine has.
#pragma once

#include <cstdint>
#include <string_view>

namespace ltsim {

enum class Cpu : std::uint8_t {
  many,      ///< one for each task: whoever can run may take the next step, whatever its priority
  one_fifo,  ///< one that honours SCHED_FIFO: priority inversion and starvation are then real
};

/// "many", "one-fifo": as on the command line and in schedules.
[[nodiscard]] constexpr std::string_view to_string(Cpu cpu) noexcept {
  return cpu == Cpu::many ? "many" : "one-fifo";
}

}  // namespace ltsim
