// An interrupted proof as a file: where the search stands, and what it is a search of.
//
//   ltsim proof 2
//   scenario  paper/three-requests
//   program   8a31b6c0d22f4b17
//   bounds    at most 2 preemptions and 1 silence, memory sc, 4 looks
//   counted   12033 executions, 107 redundant, 0 cut off, 0 held back, 924511 points, 0 states, 1 parts, 1.25 s
//   task 1 of 0x3 to-try 0x3 tried 0x1 asleep 0x0
//   time 0 of 2
//   ...
//
// It belongs to the very program that has written it: another build makes other choices.
#pragma once

#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "sim_clock/explore/prover.hpp"

namespace ltsim {

[[nodiscard]] std::string to_proof(const ProveReport& report, std::string_view scenario,
                                   const ProveOptions& options);

/// @return  what was counted, and the checkpoint; or why the text is none of this search
[[nodiscard]] tl::expected<ProveReport, std::string> parse_proof(std::string_view text,
                                                                 std::string_view scenario,
                                                                 const ProveOptions& options);

}  // namespace ltsim
