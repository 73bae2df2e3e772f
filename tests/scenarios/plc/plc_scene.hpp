// What a scenario of the soft PLC is made of. All of them are one plant: two cycles, one driver over shared memory, an
// operator who gives orders, two field devices at the gateway, and a field whose inputs change.
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

#include "sim_clock/world/world.hpp"

namespace scenarios {

struct PlcScene {
  enum class Threading : std::uint8_t { per_cycle, one };
  enum class Clock : std::uint8_t {
    steady,
    wall,             ///< mutant: the clock that people set
    milliseconds_32,  ///< mutant: a count of 32 bits, which wraps 40 ms after the start
  };
  enum class Inputs : std::uint8_t {
    latched,
    live,  ///< mutant: the program looks at the terminals
  };
  enum class Driver : std::uint8_t {
    through_gate,
    past_gate,     ///< mutant: a frame that was taken is written, whatever has happened since
    word_by_word,  ///< mutant: the terminals of each cycle pass the gate by themselves
  };

  enum class Operator : std::uint8_t {
    gives_orders,  ///< RUN, then some at choice
    acknowledges,  ///< RUN, and after a fault, as soon as it is seen, reset and RUN
  };
  enum class Hang : std::uint8_t {
    never,
    may,          ///< one scan of the first cycle, within a slice or slice by slice
    second_scan,  ///< of the first cycle, within a slice
  };

  Threading threading = Threading::per_cycle;
  Clock clock = Clock::steady;
  Inputs inputs = Inputs::latched;
  Driver driver = Driver::through_gate;
  std::chrono::microseconds period{10'000};  ///< of the first cycle; the second one has twice that
  std::chrono::microseconds watchdog_limit{30'000};
  /// SCHED_FIFO on one processor. A scan that hangs computes, and the driver is late by up to a period of its own.
  bool realtime = false;
  bool catches_up = false;  ///< instead of skipping the starts that were missed
  Hang hang = Hang::never;
  Operator panel = Operator::gives_orders;
  bool driver_may_fail = false;
  unsigned stalls = 0;          ///< of the whole PLC
  unsigned clock_steps = 0;     ///< of the wall clock
  unsigned orders = 3;          ///< after the first RUN; or looks at the lamp
  unsigned field_requests = 0;  ///< of each of two field devices
  std::string_view only = {};   ///< the one invariant that is judged, where one mistake breaks several
};

/// Over the code as it is.
void run_unmutated(ltsim::World& world, const PlcScene& scene);

}  // namespace scenarios
