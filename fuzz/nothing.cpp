// What the engine costs by itself, for tests/bench/fuzz_rates.sh.

#include "sim_clock/scenario/fuzz_target.hpp"

FUZZ_TARGET("nothing", {}, "does nothing with its input") {}
