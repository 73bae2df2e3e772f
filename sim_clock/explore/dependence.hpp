// Whether the order of two steps can matter to anybody: what a reduction may rely on. Errs on the side of yes.
//
// depend() of operation.hpp is a hint for strategies that sample, and may be wrong either way; this may not say no where it
// matters.
#pragma once

#include "sim_clock/world/operation.hpp"

namespace ltsim {

/// What a step does to others.
struct StepEffect {
  Operation operation;
  bool looks = false;       ///< it changed nothing: it failed, or found what others had made
  bool is_barrier = false;  ///< its order matters to every other step
};

/// @param memory_is_weak  seq_cst operations depend on each other wherever they act
[[nodiscard]] bool order_matters(const StepEffect& one, const StepEffect& other,
                                 bool memory_is_weak) noexcept;

}  // namespace ltsim
