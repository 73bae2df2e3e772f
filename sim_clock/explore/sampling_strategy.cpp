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
  time_mode_ = begin();
  if (time_mode_ == TimeMode::bursts) burst_bits_ = 3 + generator_.below(11);
  slow_moments_.begin(generator_, time_mode_ == TimeMode::silence ? 1 + generator_.below(3) : 0);
  for (Occasions& fault : faults_)
    fault.begin(generator_, generator_.below(2) == 0 ? 0 : 1 + generator_.below(2));
}

void SamplingStrategy::learn(const ExecutionSummary& /*summary*/) noexcept {
  slow_moments_.learn();
  for (Occasions& fault : faults_) {
    if (fault.passed() != 0) fault.learn();
  }
}

SlowMoment SamplingStrategy::slow_moment(const SlowMomentChoice& choice) noexcept {
  const bool is_place = slow_moments_.pass() != 0;
  switch (time_mode_) {
    case TimeMode::calm:
      return {};
    case TimeMode::bursts:
      return generator_.bits(burst_bits_) == 0 ? draw_slow_moment(choice.until_next_timer) : SlowMoment{};
    case TimeMode::silence:
      return is_place ? draw_slow_moment(choice.until_next_timer) : SlowMoment{};
    case TimeMode::clock:
      if (choice.until_next_timer > longest_silence || !clock_goes_first(choice)) return {};
      return {.duration = std::max(choice.until_next_timer, SimTime{1})};
  }
  return {};
}

SlowMoment SamplingStrategy::draw_slow_moment(SimTime until_next_timer) noexcept {
  SlowMoment moment;
  moment.others_go_on = generator_.below(2) == 1;
  const bool a_timer_is_near = until_next_timer <= longest_silence;
  if (a_timer_is_near && generator_.below(2) == 0) {
    // Just past the n-th multiple, n = 1 in one case of two, 2 to 3 in one of four ...
    std::uint32_t multiple = 1;
    while (multiple < 64 && generator_.bits(1) == 1) multiple *= 2;
    multiple += generator_.below(multiple);
    moment.duration = std::min(std::max(until_next_timer, SimTime{1}) * multiple, longest_silence);
  } else {
    const std::uint32_t order = generator_.below(orders_of_magnitude + 1);
    const SimTime least = shortest_slow_moment * (std::int64_t{1} << order);
    moment.duration = least + least / 8 * generator_.below(8);
  }
  return moment;
}

std::size_t SamplingStrategy::strike(FaultKind kind, std::size_t variants_count) noexcept {
  if (faults_[static_cast<std::size_t>(kind)].pass() == 0) return 0;
  return 1 + generator_.below(static_cast<std::uint32_t>(variants_count));
}

std::size_t SamplingStrategy::answer(std::size_t count) noexcept {
  return generator_.below(static_cast<std::uint32_t>(count));
}

}  // namespace ltsim
