// The scheduler's part in faults: asks whether one strikes, and what it does to tasks, which are killed, get no
// processor, or wait by a clock that is set.

#include <algorithm>

#include "sim_clock/check/self_check.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {

std::size_t Scheduler::strike(FaultKind kind, std::size_t variants_count) noexcept {
  if (in_fair_tail()) return 0;
  ++decisions_;
  const std::size_t variant = strategy_->strike(kind, variants_count);
  LTSIM_CHECK(variant <= variants_count);
  if (variant != 0) mix(std::uint64_t{static_cast<std::uint8_t>(kind)} << 32U | variant);
  return variant;
}

void Scheduler::kill_tasks(ProcessId process) noexcept {
  for (std::size_t i = 0; i < tasks_count_; ++i) {
    Task& task = *tasks_[i];
    if (task.process != process || task.state == Task::State::finished || task.state == Task::State::killed)
      continue;
    if (task.state == Task::State::runnable) make_unrunnable(task);
    if (task.state == Task::State::stalled) --stalled_count_;
    clock_.cancel(task.id);
    task.state = Task::State::killed;
    --unfinished_count_;
    --unfinished_in_[process];
  }
  no_processor_before_[process] = SimTime{0};  // what is started again is another process
  // Only now: a task of this process must not be woken.
  for (std::size_t i = 0; i < tasks_count_; ++i) {
    if (tasks_[i]->process == process) world_.mutexes().owner_died(tasks_[i]->id);
  }
}

void Scheduler::stall_process(ProcessId process, SimTime duration) noexcept {
  const SimTime end = clock_.now() + duration;
  no_processor_before_[process] = std::max(no_processor_before_[process], end);
  for (std::size_t i = 0; i < tasks_count_; ++i) {
    Task& task = *tasks_[i];
    if (task.process != process || task.state != Task::State::runnable) continue;
    make_unrunnable(task);
    make_runnable(task);  // when the stall is over; so will those be that something wakes meanwhile
  }
}

void Scheduler::wait_for_processor() noexcept {
  Task& self = *running_;
  if (self.state != Task::State::stalled) return;
  self.is_held_up_at_point = true;
  Task* const other = next_after_stop();
  if (other != &self) switch_to(*other);
  self.is_held_up_at_point = false;
}

void Scheduler::leave_killed() noexcept {
  Task& self = *running_;
  leave(self);
  LTSIM_UNREACHABLE("a killed task was resumed");
}

void Scheduler::wall_clock_was_stepped(SimTime forward) noexcept {
  for (std::size_t i = 0; i < tasks_count_; ++i) {
    Task& task = *tasks_[i];
    if (task.state != Task::State::blocked || !task.deadline_on_wall_clock ||
        task.deadline == VirtualClock::never) {
      continue;
    }
    task.deadline = std::max(task.deadline - forward, SimTime{0});
    clock_.arm(task.deadline, task.id);
  }
}

void Scheduler::delay_start(Task& task, SimTime begin) noexcept {
  make_unrunnable(task);
  task.state = Task::State::stalled;
  ++stalled_count_;
  clock_.arm(begin, task.id);
}

}  // namespace ltsim
