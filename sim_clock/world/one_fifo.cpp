// Scheduler on a machine with one processor that honours priorities (Cpu::one_fifo), as Linux does for SCHED_FIFO
// and SCHED_RR (sched(7)): the highest priority that can run runs. Among equals of SCHED_FIFO the one that has
// been ready for longest runs until it blocks or yields; tasks of SCHED_RR, and those without a priority, share
// the processor in any order, which is the strategy's choice.

#include <algorithm>

#include "sim_clock/world/scheduler.hpp"

namespace ltsim {

std::span<const std::uint64_t> Scheduler::keep_highest_priority(
    std::span<const std::uint64_t> options) noexcept {
  int highest = 0;
  for (const std::uint64_t option : options) highest = std::max(highest, tasks_[option]->effective_priority);
  // In place: what is kept only moves towards the front.
  std::size_t count = 0;
  const Task* first = nullptr;
  for (const std::uint64_t option : options) {
    const Task& task = *tasks_[option];
    if (task.effective_priority != highest) continue;
    options_[count++] = option;
    if (first == nullptr || task.ready_since < first->ready_since) first = &task;
  }
  const bool share = first == nullptr || highest == 0 || first->time_sharing;
  if (!share) {
    options_[0] = first->id;
    count = 1;
  }
  return std::span{options_}.first(count);
}

void Scheduler::set_priority(Task& task, int priority, bool time_sharing) noexcept {
  task.priority = priority;
  task.time_sharing = time_sharing;
  update_priority(task);
}

void Scheduler::lend_priority(Task& waiter, Task& owner) noexcept {
  waiter.lends_to = owner.id;
  // An owner may wait for another owner in turn.
  for (Task* next = &owner; next->effective_priority < waiter.effective_priority;
       next = tasks_[next->lends_to].get()) {
    next->effective_priority = waiter.effective_priority;
    if (next->state != Task::State::blocked || next->lends_to == VirtualClock::no_task) break;
  }
}

void Scheduler::end_lending(WaitKey key, Task* next_owner) noexcept {
  for (std::size_t i = 0; i < tasks_count_; ++i) {
    Task& waiter = *tasks_[i];
    if (waiter.state != Task::State::blocked || waiter.wait_key != key) continue;
    waiter.lends_to = VirtualClock::no_task;
    if (next_owner != nullptr) lend_priority(waiter, *next_owner);
  }
}

void Scheduler::update_priority(Task& task) noexcept {
  task.effective_priority = task.priority;
  for (std::size_t i = 0; i < tasks_count_; ++i) {
    const Task& waiter = *tasks_[i];
    if (waiter.state == Task::State::blocked && waiter.lends_to == task.id)
      task.effective_priority = std::max(task.effective_priority, waiter.effective_priority);
  }
}

}  // namespace ltsim
