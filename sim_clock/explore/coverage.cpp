#include "sim_clock/explore/coverage.hpp"

#include <algorithm>

namespace ltsim {

void Coverage::forget() {
  std::fill(seen_.begin(), seen_.end(), 0);
  new_count_ = 0;
}

}  // namespace ltsim
