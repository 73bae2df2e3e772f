#include "sim_clock/explore/stall_strategy.hpp"

#include <algorithm>
#include <bit>

#include "sim_clock/explore/task_set.hpp"

namespace ltsim {
namespace {

/// Whether others may see the world otherwise afterwards.
bool changes_something(const Operation& operation) noexcept {
  switch (operation.kind) {
    case OperationKind::sem_post:
    case OperationKind::mutex_unlock:
    case OperationKind::cond_signal:
    case OperationKind::cond_broadcast:
    case OperationKind::futex_wake:
    case OperationKind::rwlock_unlock:
    case OperationKind::spin_unlock:
    case OperationKind::barrier_wait:
      return true;
    default:
      return changes_memory(operation.kind);
  }
}

}  // namespace

SamplingStrategy::TimeMode StallStrategy::begin() noexcept {
  silent_ = nobody;
  silences().begin(generator(), 1 + generator().below(3));
  return generator().below(4) == 0 ? TimeMode::silence : TimeMode::clock;
}

void StallStrategy::learn(const ExecutionSummary& summary) noexcept {
  SamplingStrategy::learn(summary);
  silences().learn();
}

void StallStrategy::begin_silence(TaskId task) noexcept {
  silent_ = task;
  counts_changes_ = generator().below(2) == 0;
  const auto length = static_cast<std::uint32_t>(std::bit_width(silences().estimate()));
  const std::uint32_t order = generator().below(counts_changes_ ? 6 : length + 3);
  left_ = (std::uint64_t{1} << order) + generator().below(std::uint32_t{1} << order);
}

std::size_t StallStrategy::choose_task(const TaskChoice& choice) noexcept {
  const auto count = static_cast<std::uint32_t>(choice.options.size());
  const bool can_be_silent =
      std::find(choice.options.begin(), choice.options.end(), choice.running) != choice.options.end();
  if (can_be_silent && matters(choice.pending[choice.running]) && silences().pass() != 0)
    begin_silence(choice.running);
  const std::uint32_t chosen = generator().below(count);
  if (choice.options[chosen] != silent_) return chosen;
  // One of the others, each alike.
  return (chosen + 1 + generator().below(count - 1)) % count;
}

bool StallStrategy::clock_goes_first(const SlowMomentChoice& choice) noexcept {
  if (silent_ == nobody) {
    // Alone, too, a task can fall silent: its peers wait with a time-out.
    if (!choice.running_can_be_held_up || !matters(choice.pending[choice.running])) return false;
    if (silences().pass() == 0) return false;
    begin_silence(choice.running);
  }
  bool others_can_run = false;
  for_each_task(choice.runnable, [&](TaskId task) { others_can_run = others_can_run || task != silent_; });
  if (others_can_run) return false;
  if (!counts_changes_) count_down();
  return silent_ != nobody;
}

void StallStrategy::performs(TaskId task, const Operation& operation) noexcept {
  note_use(task, operation);
  if (silent_ == nobody) return;
  if (task == silent_) {
    silent_ = nobody;  // nobody else could run
  } else if (!counts_changes_ || changes_something(operation)) {
    count_down();
  }
}

void StallStrategy::count_down() noexcept {
  if (--left_ == 0) silent_ = nobody;
}

}  // namespace ltsim
