#include "emulator_models/soft_plc/start_delays.hpp"

#include <numeric>

namespace emulator_models::soft_plc {

using std::chrono::nanoseconds;

std::uint64_t StartDelays::count_in(std::size_t range) const noexcept {
  const auto first = steps_.begin() + static_cast<std::ptrdiff_t>(range * steps_per_range);
  return std::accumulate(first, first + steps_per_range, std::uint64_t{0});
}

nanoseconds StartDelays::percentile(std::uint64_t permille) const noexcept {
  // Rounded up: of 10 scans, 999 per mille are all 10.
  const std::uint64_t wanted = (count_ * permille + 999) / 1000;
  std::uint64_t seen = 0;
  for (std::size_t step = 0; step < steps_count; ++step) {
    seen += steps_[step];
    if (seen < wanted) continue;
    const std::size_t range = step / steps_per_range;
    const auto steps = static_cast<std::int64_t>(step % steps_per_range + 1);
    return std::min(longest_, begin_of(range) + steps * step_of(range));
  }
  return longest_;
}

}  // namespace emulator_models::soft_plc
