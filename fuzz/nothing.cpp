// The empty target: what the engine costs by itself.

#include "sim_clock/scenario/fuzz_target.hpp"

FUZZ_TARGET("nothing", {}, "does nothing with its input") {}
