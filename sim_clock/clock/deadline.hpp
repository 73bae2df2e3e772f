// When a wait ends of its own accord.
#pragma once

#include "sim_clock/clock/virtual_clock.hpp"

namespace ltsim {

struct Deadline {
  /// @param time  of the world; VirtualClock::never: no limit
  Deadline(SimTime of_world) noexcept : time(of_world) {}
  /// @param time  since 1970, by the wall clock; VirtualClock::never: no limit
  [[nodiscard]] static Deadline on_wall_clock_at(SimTime time) noexcept {
    Deadline deadline{time};
    deadline.on_wall_clock = true;
    return deadline;
  }

  SimTime time;
  bool on_wall_clock = false;  ///< a step of the wall clock brings it nearer or moves it away
};

}  // namespace ltsim
