#include "sim_clock/explore/random_strategy.hpp"

namespace ltsim {
namespace {

constexpr SimTime shortest_slow_moment{1000};
constexpr std::uint32_t slow_moments_count = 21;  // 1 us << 20 is about 1 s

}  // namespace

void RandomStrategy::begin_execution(std::uint64_t seed) noexcept {
  generator_ = RandomGenerator{seed};
  slow_moment_bits_ = 3 + generator_.below(11);  // one slow moment in 8 to 8192 points
  fault_bits_ = 1 + generator_.below(12);        // one fault in 2 to 4096 occasions
}

std::size_t RandomStrategy::choose_task(const TaskChoice& choice) noexcept {
  // Most choices are between two tasks: one bit.
  return choice.options.size() == 2 ? generator_.bits(1)
                                    : generator_.below(static_cast<std::uint32_t>(choice.options.size()));
}

std::size_t RandomStrategy::strike(FaultKind /*kind*/, std::size_t variants_count) noexcept {
  if (generator_.bits(fault_bits_) != 0) return 0;
  return 1 + generator_.below(static_cast<std::uint32_t>(variants_count));
}

std::size_t RandomStrategy::answer(std::size_t count) noexcept {
  return generator_.below(static_cast<std::uint32_t>(count));
}

SlowMoment RandomStrategy::slow_moment(const SlowMomentChoice& choice) noexcept {
  if (generator_.bits(slow_moment_bits_) != 0) return {};
  const bool others_go_on = generator_.below(2) == 1;
  const bool a_timer_is_armed = choice.until_next_timer != VirtualClock::never;
  const std::uint32_t chosen = generator_.below(slow_moments_count + (a_timer_is_armed ? 1 : 0));
  return {.duration = chosen == slow_moments_count ? choice.until_next_timer
                                                   : shortest_slow_moment * (std::int64_t{1} << chosen),
          .others_go_on = others_go_on};
}

}  // namespace ltsim
