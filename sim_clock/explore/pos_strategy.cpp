#include "sim_clock/explore/pos_strategy.hpp"

#include <algorithm>

#include "sim_clock/explore/task_set.hpp"

namespace ltsim {

SamplingStrategy::TimeMode PosStrategy::begin() noexcept {
  priorities_.fill(0);
  tasks_seen_ = 0;
  return generator().below(2) == 0 ? TimeMode::silence : TimeMode::clock;
}

std::size_t PosStrategy::choose_task(const TaskChoice& choice) noexcept {
  pending_ = choice.pending;
  if (choice.running_gives_way) priorities_[choice.running] = lowest;
  std::size_t best = 0;
  for (std::size_t i = 1; i < choice.options.size(); ++i) {
    if (priority_of(choice.options[i]) > priority_of(choice.options[best])) best = i;
  }
  return best;
}

bool PosStrategy::clock_goes_first(const SlowMomentChoice& choice) noexcept {
  pending_ = choice.pending;
  bool first = true;
  for_each_task(choice.runnable,
                [&](TaskId task) { first = first && priority_of(clock) > priority_of(task); });
  if (first) priorities_[clock] = 0;
  return first;
}

void PosStrategy::performs(TaskId task, const Operation& operation) noexcept {
  priorities_[task] = 0;
  for (std::size_t other = 0; other < tasks_seen_; ++other) {
    if (priorities_[other] != 0 && depend(pending_[other], operation)) priorities_[other] = 0;
  }
}

std::uint64_t PosStrategy::priority_of(std::size_t task) noexcept {
  if (priorities_[task] == 0) {
    const bool is_free = task != clock && pending_[task].kind == OperationKind::clock_read;
    priorities_[task] = is_free ? highest : std::clamp(generator().next(), lowest + 1, highest - 1);
    if (task != clock) tasks_seen_ = std::max(tasks_seen_, task + 1);
  }
  return priorities_[task];
}

}  // namespace ltsim
