// An interrupted proof as a file: where the search stands, and what it is a search of.
//
//   ltsim proof 3
//   scenario  paper/three-requests
//   program   8a31b6c0d22f4b17
//   bounds    at most 2 preemptions and 1 silence, memory sc, 4 looks
//   took      1.25 s in 1 runs
//   states    0
//   part 12033 executions, 107 redundant, 0 cut off, 0 held back, 924511 points
//   branch 1 0                        so many parts of it follow, before them so many were over
//   task 0 of 0x3 to-try 0,1 tried 0x0 asleep 0x0
//   task 0 of 0x3 to-try 0,1 tried 0x0 asleep 0x0      with which the part begins
//   part 310 executions, 0 redundant, 0 cut off, 0 held back, 30220 points
//   asks 0 0x6                        at that decision one of these tasks must be tried, too
//   leaf 2                            so many decisions follow, at which the search of it stands
//   task 1 of 0x3 to-try 0,1 tried 0x1 asleep 0x0
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
