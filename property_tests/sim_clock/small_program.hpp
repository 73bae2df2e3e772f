// Programs of a few tasks that are data: what each task does, step by step, on two words and two semaphores.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <vector>

#include <rapidcheck.h>

#include "sim_clock/scenario/scenario.hpp"

namespace property_tests {

struct Step {
  enum class Kind : std::uint8_t {
    add,       ///< load, then store one more: an update can be lost
    count,     ///< the same in one step
    wait,      ///< for a semaphore that is 0 at first
    post,      ///< it
    sleep,     ///< `argument` + 1 milliseconds
    time_out,  ///< wait for a semaphore, 1 ms at most
    ask,       ///< a question of three answers
  };
  Kind kind = Kind::add;
  unsigned which = 0;  ///< word or semaphore, 0 or 1
};

struct SmallProgram {
  std::vector<std::vector<Step>> tasks;
};

void showValue(const SmallProgram& program, std::ostream& out);

/// Two or three tasks of one to four steps.
[[nodiscard]] rc::Gen<SmallProgram> any_small_program(std::vector<Step::Kind> kinds);

/// Fails if an update is lost, if two answers that were not 0 were given, or by a deadlock.
[[nodiscard]] ltsim::Scenario scenario_of(const SmallProgram& program);

/// The one of this program.
[[nodiscard]] ltsim::World& world();

}  // namespace property_tests
