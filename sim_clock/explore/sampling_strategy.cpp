#include "sim_clock/explore/sampling_strategy.hpp"

#include <algorithm>
#include <bit>

namespace ltsim {
namespace {

constexpr SimTime shortest_slow_moment{1000};
constexpr SimTime longest_silence = std::chrono::seconds{16};
constexpr std::uint32_t orders_of_magnitude = 20;  // 1 us << 20 is about 1 s

}  // namespace

void SamplingStrategy::begin_execution(std::uint64_t seed) noexcept {
  generator_ = RandomGenerator{seed};
  experience_->period = experience_->period_learned;
  experience_->things.begin();
  all_matters_ = generator_.below(4) == 0;
  clock_turns_left_ = std::uint32_t{8} << generator_.below(8);
  time_mode_ = begin();
  if (time_mode_ == TimeMode::bursts) burst_bits_ = 3 + generator_.below(11);
  slow_moments().begin(generator_, time_mode_ == TimeMode::silence ? 1 + generator_.below(3) : 0);
  faults_asked_for_ = 0;
  staleness_ = Staleness{};
}

void SamplingStrategy::learn(const ExecutionSummary& /*summary*/) noexcept {
  experience_->period_learned = experience_->period;
  experience_->things.learn();
  if (slow_moments().passed() != 0) slow_moments().learn();
  for (std::uint32_t kinds = faults_asked_for_; kinds != 0; kinds &= kinds - 1) {
    // A fault that has struck as often as it may is not asked for any more.
    Occasions& fault = experience_->faults[static_cast<std::size_t>(std::countr_zero(kinds))];
    fault.learn(!fault.any_hit());
  }
}

SlowMoment SamplingStrategy::slow_moment(const SlowMomentChoice& choice) noexcept {
  if (choice.until_next_timer != VirtualClock::never)
    experience_->period = std::max(choice.until_next_timer, SimTime{1});
  if (!choice.running_can_be_held_up && time_mode_ != TimeMode::clock) return {};
  switch (time_mode_) {
    case TimeMode::bursts:
      return generator_.bits(burst_bits_) == 0 ? draw_slow_moment() : SlowMoment{};
    case TimeMode::silence:
      if (!matters(choice.pending[choice.running]) || slow_moments().pass() == 0) return {};
      return draw_slow_moment();
    case TimeMode::clock:
      if (choice.until_next_timer > longest_silence || clock_turns_left_ == 0) return {};
      if (!clock_goes_first(choice)) return {};
      --clock_turns_left_;
      return {.duration = std::max(choice.until_next_timer, SimTime{1})};
  }
  return {};
}

SamplingStrategy::TimeMode SamplingStrategy::draw_time_mode() noexcept {
  const std::uint32_t drawn = generator_.below(16);
  if (drawn == 0) return TimeMode::bursts;
  return drawn < 6 ? TimeMode::silence : TimeMode::clock;
}

SlowMoment SamplingStrategy::draw_slow_moment() noexcept {
  const SimTime period = experience_->period;
  if (period != SimTime{0} && period <= longest_silence && generator_.below(4) != 0) {
    // 1, 2 to 3, 4 to 7, 8 to 15: as often each.
    const std::uint32_t order = generator_.below(4);
    const std::uint32_t multiple = (std::uint32_t{1} << order) + generator_.below(std::uint32_t{1} << order);
    const bool others_go_on = multiple > 1 || generator_.below(2) == 1;
    return {.duration = std::min(period * multiple, longest_silence), .others_go_on = others_go_on};
  }
  const std::uint32_t order = generator_.below(orders_of_magnitude + 1);
  const SimTime least = shortest_slow_moment * (std::int64_t{1} << order);
  return {.duration = least + least / 8 * generator_.below(8), .others_go_on = generator_.below(2) == 1};
}

std::size_t SamplingStrategy::note_use(TaskId task, const Operation& operation) noexcept {
  const std::size_t thing = experience_->things.thing_of(operation);
  if (thing != SharedThings::none) experience_->things.use(thing, task, operation.is_contended);
  return thing;
}

bool SamplingStrategy::matters(const Operation& operation) noexcept {
  if (all_matters_) return true;
  const std::size_t thing = experience_->things.thing_of(operation);
  return thing != SharedThings::none && experience_->things.is_shared(thing);
}

std::size_t SamplingStrategy::strike(FaultKind kind, std::size_t variants_count) noexcept {
  Occasions& fault = experience_->faults[static_cast<std::size_t>(kind)];
  const std::uint32_t bit = std::uint32_t{1} << static_cast<unsigned>(kind);
  if ((faults_asked_for_ & bit) == 0) {
    faults_asked_for_ |= bit;
    fault.begin(generator_, generator_.below(4) == 0 ? 0 : 1 + generator_.below(2));
  }
  if (fault.pass() == 0) return 0;
  return 1 + generator_.below(static_cast<std::uint32_t>(variants_count));
}

std::size_t SamplingStrategy::answer(std::size_t count) noexcept {
  return generator_.below(static_cast<std::uint32_t>(count));
}

std::size_t SamplingStrategy::choose_age(const AgeChoice& choice) noexcept {
  if (!staleness_.drawn) {
    staleness_.drawn = true;
    staleness_.bits = generator_.below(4) == 0 ? 0 : 1 + generator_.below(4);
    staleness_.goes_on = generator_.below(2) == 1;
  }
  if (staleness_.bits == 0) return 0;
  if (staleness_.left != 0 && staleness_.task == choice.running) {
    --staleness_.left;
    return choice.ages.size() - 1;
  }
  if (generator_.bits(staleness_.bits) != 0) return 0;
  if (staleness_.goes_on && staleness_.left == 0) {
    staleness_.task = choice.running;
    staleness_.left = generator_.below(std::uint32_t{1} << (1 + generator_.below(6)));
  }
  return 1 + generator_.below(static_cast<std::uint32_t>(choice.ages.size() - 1));
}

}  // namespace ltsim
