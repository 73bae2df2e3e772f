#include "sim_clock/explore/sampling_strategy.hpp"

#include <algorithm>

namespace ltsim {
namespace {

constexpr SimTime shortest_slow_moment{1000};
constexpr SimTime longest_silence = std::chrono::seconds{16};
constexpr std::uint32_t orders_of_magnitude = 20;  // 1 us << 20 is about 1 s

}  // namespace

void SamplingStrategy::begin_execution(std::uint64_t seed) noexcept {
  generator_ = RandomGenerator{seed};
  period_ = period_learned_;
  time_mode_ = begin();
  if (time_mode_ == TimeMode::bursts) burst_bits_ = 3 + generator_.below(11);
  slow_moments_.begin(generator_, time_mode_ == TimeMode::silence ? 1 + generator_.below(3) : 0);
  for (Occasions& fault : faults_)
    fault.begin(generator_, generator_.below(2) == 0 ? 0 : 1 + generator_.below(2));
}

void SamplingStrategy::learn(const ExecutionSummary& /*summary*/) noexcept {
  period_learned_ = period_;
  if (slow_moments_.passed() != 0) slow_moments_.learn();
  for (Occasions& fault : faults_) {
    if (fault.passed() != 0) fault.learn();
  }
}

SlowMoment SamplingStrategy::slow_moment(const SlowMomentChoice& choice) noexcept {
  if (choice.until_next_timer != VirtualClock::never) period_ = std::max(choice.until_next_timer, SimTime{1});
  switch (time_mode_) {
    case TimeMode::bursts:
      return generator_.bits(burst_bits_) == 0 ? draw_slow_moment() : SlowMoment{};
    case TimeMode::silence:
      if (!acts_on_something(choice.pending[choice.running]) || slow_moments_.pass() == 0) return {};
      return draw_slow_moment();
    case TimeMode::clock:
      if (choice.until_next_timer > longest_silence || !clock_goes_first(choice)) return {};
      return {.duration = std::max(choice.until_next_timer, SimTime{1})};
  }
  return {};
}

SlowMoment SamplingStrategy::draw_slow_moment() noexcept {
  if (period_ != SimTime{0} && period_ <= longest_silence && generator_.below(4) != 0) {
    // 1, 2 to 3, 4 to 7, 8 to 15: as often each.
    const std::uint32_t order = generator_.below(4);
    const std::uint32_t multiple = (std::uint32_t{1} << order) + generator_.below(std::uint32_t{1} << order);
    const bool others_go_on = multiple > 1 || generator_.below(2) == 1;
    return {.duration = std::min(period_ * multiple, longest_silence), .others_go_on = others_go_on};
  }
  const std::uint32_t order = generator_.below(orders_of_magnitude + 1);
  const SimTime least = shortest_slow_moment * (std::int64_t{1} << order);
  return {.duration = least + least / 8 * generator_.below(8), .others_go_on = generator_.below(2) == 1};
}

std::size_t SamplingStrategy::strike(FaultKind kind, std::size_t variants_count) noexcept {
  if (faults_[static_cast<std::size_t>(kind)].pass() == 0) return 0;
  return 1 + generator_.below(static_cast<std::uint32_t>(variants_count));
}

std::size_t SamplingStrategy::answer(std::size_t count) noexcept {
  return generator_.below(static_cast<std::uint32_t>(count));
}

}  // namespace ltsim
