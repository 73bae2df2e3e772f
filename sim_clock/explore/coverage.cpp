#include "sim_clock/explore/coverage.hpp"

#include <algorithm>

namespace ltsim {

void Coverage::forget() {
  std::ranges::fill(seen_.bytes(), std::byte{0});
  new_count_ = 0;
}

}  // namespace ltsim
