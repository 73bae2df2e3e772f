#include "sim_clock/explore/swarm_strategy.hpp"

#include <algorithm>
#include <numeric>

namespace ltsim {

void SwarmStrategy::begin_execution(std::uint64_t seed) noexcept {
  // Not the generator of the member: what it draws must not depend on how it was drawn itself.
  RandomGenerator generator{splitmix64(seed)};
  const std::uint32_t yields = std::accumulate(yields_.begin(), yields_.end(), std::uint32_t{0});
  by_cycle_ = yields == 0 || executions_ % 4 != 3;
  if (by_cycle_) {
    drawn_ = cycle[cycle_executions_ % cycle.size()];
  } else {
    std::uint32_t place = generator.below(yields);
    for (drawn_ = 0; place >= yields_[drawn_]; ++drawn_) place -= yields_[drawn_];
  }
  current_ = members_[drawn_];
  current_->begin_execution(seed);
}

void SwarmStrategy::learn(const ExecutionSummary& summary) noexcept {
  ++executions_;
  if (by_cycle_) ++cycle_executions_;
  current_->learn(summary);
  constexpr std::uint32_t worth_of_a_failure = 4096;
  constexpr std::uint64_t most_at_once = 1024;
  const auto states = static_cast<std::uint32_t>(std::min(summary.new_states * 16, most_at_once));
  yields_[drawn_] -= (yields_[drawn_] + 31) / 32;
  yields_[drawn_] += states + (summary.failed_anew ? worth_of_a_failure : 0);
}

}  // namespace ltsim
