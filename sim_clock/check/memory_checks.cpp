#include "sim_clock/check/memory_checks.hpp"

namespace ltsim {

void MemoryChecks::reset() noexcept {
  // What happened to memory while the checks were off does not matter: a segment is filled with zeros in both
  // places when it gets its size.
  on_ = wanted_on_;
  follows_order_ = on_;
  races_allowed_ = false;
  order_.reset();
  races_.reset();
  watch_.reset();
  coverage_.begin_execution();
}

}  // namespace ltsim
