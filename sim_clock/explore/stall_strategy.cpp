#include "sim_clock/explore/stall_strategy.hpp"

#include <bit>

#include "sim_clock/explore/task_set.hpp"

namespace ltsim {

SamplingStrategy::TimeMode StallStrategy::begin() noexcept {
  events_left_ = 0;
  silences_.begin(generator(), 1 + generator().below(3));
  return generator().below(2) == 0 ? TimeMode::silence : TimeMode::clock;
}

void StallStrategy::learn(const ExecutionSummary& summary) noexcept {
  SamplingStrategy::learn(summary);
  silences_.learn();
}

std::size_t StallStrategy::choose_task(const TaskChoice& choice) noexcept {
  const auto count = static_cast<std::uint32_t>(choice.options.size());
  if (silences_.pass() != 0) {
    const auto orders = static_cast<std::uint32_t>(std::bit_width(silences_.estimate())) + 2;
    const std::uint32_t order = generator().below(orders + 1);
    events_left_ = (std::uint64_t{1} << order) + generator().below(std::uint32_t{1} << order);
    silent_ = static_cast<TaskId>(choice.options[generator().below(count)]);
  }
  const std::uint32_t chosen = generator().below(count);
  if (choice.options[chosen] != silent_ || !pass_event()) return chosen;
  // One of the others, each alike.
  return (chosen + 1 + generator().below(count - 1)) % count;
}

bool StallStrategy::clock_goes_first(const SlowMomentChoice& choice) noexcept {
  if (events_left_ == 0) return false;
  bool others_can_run = false;
  for_each_task(choice.runnable, [&](TaskId task) { others_can_run = others_can_run || task != silent_; });
  return !others_can_run && pass_event();
}

bool StallStrategy::pass_event() noexcept {
  if (events_left_ == 0) return false;
  --events_left_;
  return true;
}

}  // namespace ltsim
