// Where a fuzzing engine sees which states of the simulated world an input has shown: it takes each byte of this section that is
// not zero for something that the input covers.

#include <cstdint>

#include "sim_clock/scenario/fuzz_scenario.hpp"

// A power of two: few enough to be looked through after each execution, enough for thousands of states. External and `used`, or
// it is dropped.
extern "C" {
[[gnu::section("__libfuzzer_extra_counters"), gnu::used]] std::uint8_t fuzz_state_marks[1U << 13U];
}

namespace {

[[maybe_unused]] const bool in_use = (ltsim::mark_fuzzed_states_in(fuzz_state_marks), true);

}  // namespace
