// What C++20 allows a small program to come to, straight from the axioms of the standard: all that can be read from where, in all
// orders of modification, each judged as a whole. Independent of the simulated memory, and slow.
//
// [intro.races] for happens-before, release sequences and coherence, [atomics.fences], and [atomics.order] for the single total
// order of seq_cst, in its form since P0668R5.
#pragma once

#include <set>

#include "tests/scenarios/litmus/small_program.hpp"

namespace litmus {

struct Allowed {
  std::set<Result> results;
  /// Those that only come about if a value is read that is written because of what was read: by load buffering, where
  /// sequenced-before and reads-from make a circle.
  std::set<Result> by_load_buffering;
};

/// @param program  at most 12 steps in all
[[nodiscard]] Allowed allowed_by_axioms(const Program& program);

}  // namespace litmus
