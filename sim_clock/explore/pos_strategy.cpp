#include "sim_clock/explore/pos_strategy.hpp"

#include <algorithm>

#include "sim_clock/explore/task_set.hpp"

namespace ltsim {

SamplingStrategy::TimeMode PosStrategy::begin() noexcept {
  priorities_.fill(0);
  for (std::size_t task = 0; task < tasks_seen_; ++task) looks_[task].count = 0;
  tasks_seen_ = 0;
  sleeps_are_free_ = generator().below(2) == 0;
  return draw_time_mode();
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
  // Timers mostly fire in series, of a task that sleeps between looks or tries again: one decision for several.
  if (first && generator().below(4) == 0) priorities_[clock] = 0;
  return first;
}

void PosStrategy::performs(TaskId task, const Operation& operation) noexcept {
  if (is_memory_access(operation.kind) && !changes_memory(operation.kind)) {
    Look& look = looks_[task];
    look.count = look.operation == operation ? look.count + 1 : 1;
    look.operation = operation;
    look.priority = priorities_[task];
  }
  note_use(task, operation);
  tasks_seen_ = std::max(tasks_seen_, task + std::size_t{1});
  priorities_[task] = 0;
  for (std::size_t other = 0; other < tasks_seen_; ++other) {
    if (priorities_[other] != 0 && depend(pending_[other], operation)) priorities_[other] = 0;
    if (looks_[other].count != 0 && depend(looks_[other].operation, operation)) looks_[other].count = 0;
  }
}

std::uint64_t PosStrategy::priority_of(std::size_t task) noexcept {
  if (priorities_[task] != 0) return priorities_[task];
  priorities_[task] = std::clamp(generator().next(), lowest + 1, highest - 1);
  if (task == clock) return priorities_[task];
  tasks_seen_ = std::max(tasks_seen_, task + 1);
  const Operation& operation = pending_[task];
  const bool is_free = operation.kind == OperationKind::sleep ? sleeps_are_free_ : !matters(operation);
  constexpr std::uint32_t looks_of_a_poll = 3;
  if (is_free) {
    priorities_[task] = highest;
  } else if (looks_[task].count >= looks_of_a_poll && looks_[task].operation == operation) {
    priorities_[task] = std::max(looks_[task].priority, lowest);
  }
  return priorities_[task];
}

}  // namespace ltsim
