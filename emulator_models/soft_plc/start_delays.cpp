#include "emulator_models/soft_plc/start_delays.hpp"

#include <numeric>

namespace emulator_models::soft_plc {
namespace {

using std::chrono::nanoseconds;

nanoseconds begin_of(std::size_t range) noexcept {
  return range == 0 ? nanoseconds{0} : nanoseconds{StartDelays::range_ends[range - 1]};
}

}  // namespace

void StartDelays::add(nanoseconds delay) noexcept {
  ++count_;
  longest_ = std::max(longest_, delay);
  std::size_t range = 0;
  while (range < range_ends.size() && delay >= range_ends[range]) ++range;
  if (range == range_ends.size()) {
    ++steps_.back();
    return;
  }
  const nanoseconds width = (range_ends[range] - begin_of(range)) / steps_per_range;
  ++steps_[range * steps_per_range + static_cast<std::size_t>((delay - begin_of(range)) / width)];
}

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
    const nanoseconds width = (range_ends[range] - begin_of(range)) / steps_per_range;
    return std::min(longest_,
                    begin_of(range) + width * static_cast<std::int64_t>(step % steps_per_range + 1));
  }
  return longest_;
}

}  // namespace emulator_models::soft_plc
