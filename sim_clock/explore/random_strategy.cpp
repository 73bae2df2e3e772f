#include "sim_clock/explore/random_strategy.hpp"

namespace ltsim {
namespace {

constexpr SimTime shortest_slow_moment{1000};
constexpr std::uint32_t slow_moments_count = 21;  // 1 us << 20 is about 1 s

}  // namespace

void RandomStrategy::begin_execution(std::uint64_t seed) noexcept {
  generator_ = RandomGenerator{seed};
  slow_moment_bits_ = 3 + generator_.below(11);  // one slow moment in 8 to 8192 points
}

std::size_t RandomStrategy::choose(ChoiceKind /*kind*/, std::span<const std::uint64_t> options) noexcept {
  // Most choices are between two tasks: one bit.
  return options.size() == 2 ? generator_.bits(1)
                             : generator_.below(static_cast<std::uint32_t>(options.size()));
}

SlowMoment RandomStrategy::slow_moment(SimTime until_next_timer) noexcept {
  if (generator_.bits(slow_moment_bits_) != 0) return {};
  const bool others_go_on = generator_.below(2) == 1;
  const bool a_timer_is_armed = until_next_timer != VirtualClock::never;
  const std::uint32_t chosen = generator_.below(slow_moments_count + (a_timer_is_armed ? 1 : 0));
  return {.duration = chosen == slow_moments_count ? until_next_timer
                                                   : shortest_slow_moment * (std::int64_t{1} << chosen),
          .others_go_on = others_go_on};
}

}  // namespace ltsim
