#include "sim_clock/explore/exhaustive_strategy.hpp"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "sim_clock/explore/task_set.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

/// A fault of this kind acts on more than the operation at which it strikes.
bool acts_on_all(FaultKind kind) noexcept {
  return kind == FaultKind::bit_flip || kind == FaultKind::foreign_write || kind == FaultKind::clock_step;
}

/// It strikes between steps.
bool is_step_of_its_own(FaultKind kind) noexcept {
  return kind == FaultKind::crash || kind == FaultKind::process_stall;
}

/// Not what a task does that polls.
bool is_more_than_a_look(OperationKind kind) noexcept {
  return !can_be_polling(kind) && kind != OperationKind::sleep;
}

/// It looks at a clock, or waits until a time: who polls so may have enough of it.
bool uses_clock(OperationKind kind) noexcept {
  switch (kind) {
    case OperationKind::clock_read:
    case OperationKind::sem_timedwait:
    case OperationKind::mutex_timedlock:
    case OperationKind::cond_timedwait:
    case OperationKind::futex_wait:
    case OperationKind::rwlock_timedrdlock:
    case OperationKind::rwlock_timedwrlock:
    case OperationKind::thread_timedjoin:
    case OperationKind::signal_wait:
      return true;
    default:
      return false;
  }
}

}  // namespace

ExhaustiveStrategy::ExhaustiveStrategy(World& world, ProofBounds bounds)
    : world_(world), bounds_(bounds), steps_(world, steps_max) {}

void ExhaustiveStrategy::begin_execution(std::uint64_t /*seed*/) noexcept {
  path_.begin_execution();
  asleep_ = polling_ = blocked_ = awaits_join_ = joined_ = 0;
  preemptions_ = silences_ = silence_steps_ = 0;
  silent_ = 0;
  clock_was_used_ = false;
  steps_.begin_execution();
  woken_by_.assign(steppers_count, Step::none);
  follows_.assign(steppers_count, Step::none);
  is_redundant_ = is_cut_off_ = is_held_back_ = false;
}

Decision& ExhaustiveStrategy::next_decision(Decision as_new) noexcept {
  as_new.steps = steps_.size();
  return path_.next(as_new);
}

void ExhaustiveStrategy::leave() noexcept {
  const GhostScope ghost;
  world_.scheduler().abandon();
}

std::size_t ExhaustiveStrategy::leave_as_redundant() noexcept {
  is_redundant_ = true;
  leave();
  return 0;
}

std::size_t ExhaustiveStrategy::choose_task(const TaskChoice& choice) noexcept {
  if (is_too_long()) return 0;
  look_around();
  TaskBits enabled = 0;
  for (const std::uint64_t option : choice.options) {
    if (option >= tasks_max) {
      trouble_ = fmt::format("more than {} tasks: not every order of so many can be tried", tasks_max);
      leave();
      return 0;
    }
    enabled |= task_bit(option);
  }
  const auto index_of = [&](std::size_t task) {
    return static_cast<std::size_t>(std::find(choice.options.begin(), choice.options.end(), task) -
                                    choice.options.begin());
  };
  // What a task does before its first step concerns nobody.
  for (const std::uint64_t option : choice.options) {
    if (choice.pending[option].kind == OperationKind::thread_start && !contains(choice.under_way, option))
      return index_of(option);
  }
  TaskBits waiting = 0;
  for (const std::uint64_t option : choice.options) {
    if (would_wait(option)) waiting |= task_bit(option);
  }
  // If all would, they do.
  if (waiting == enabled) return 0;
  enabled &= ~waiting;
  // Who took the last step; the one who runs may only have come to his first.
  const std::size_t runner = steps_.empty() ? the_barrier : steps_.back().stepper;
  const bool goes_on = (enabled & task_bit(runner)) != 0 && !contains(choice.under_way, runner);
  if (goes_on && !bounds_.states &&
      world_.scheduler().task(static_cast<TaskId>(runner)).looks_count >= bounds_.looks)
    polling_ |= task_bit(runner);
  if (silence_goes_on() && (enabled & ~silent_) != 0) enabled &= ~silent_;
  TaskBits candidates = enabled & ~polling_;
  is_held_back_ = is_held_back_ || (candidates != 0 && candidates != enabled);
  if (candidates == 0) candidates = enabled;
  Decision as_new{.is_of_tasks = true, .enabled = enabled};
  if (path_.is_at_end()) {
    const bool can_be_preempted = goes_on && (candidates & task_bit(runner)) != 0;
    TaskBits done = asleep_ & candidates;
    if (bounds_.states) done |= visit_state(can_be_preempted ? runner : the_barrier, asleep_) & candidates;
    TaskBits first = candidates & ~done;
    if (first == 0) {
      if (is_reduced()) add_waits(waiting);
      return leave_as_redundant();
    }
    if (puts_to_sleep()) {
      as_new.asleep = bounds_.states ? done : asleep_;
    } else if (bounds_.preemptions && can_be_preempted && preemptions_ >= *bounds_.preemptions) {
      first = task_bit(runner);
    }
    as_new.chosen =
        static_cast<std::uint32_t>((first & task_bit(runner)) != 0 ? runner : std::countr_zero(first));
    as_new.must_try(as_new.chosen);
    if (!is_reduced()) {
      for (TaskBits others = first & ~as_new.to_try; others != 0; others &= others - 1)
        as_new.must_try(static_cast<std::size_t>(std::countr_zero(others)));
    }
  }
  const Decision& decision = next_decision(as_new);
  asleep_ = puts_to_sleep() ? (decision.asleep | decision.tried) & ~task_bit(decision.chosen) : 0;
  if (goes_on && (polling_ & task_bit(runner)) == 0 && decision.chosen != runner) ++preemptions_;
  return index_of(decision.chosen);
}

void ExhaustiveStrategy::add_waits(TaskBits waiting) noexcept {
  for (TaskBits all = waiting; all != 0; all &= all - 1) {
    const auto task = static_cast<std::size_t>(std::countr_zero(all));
    Step waits{.stepper = task, .effect = pending_of(task)};
    waits.was_free = false;
    steps_.add(waits);
  }
}

void ExhaustiveStrategy::only_one_can_run(TaskId task) noexcept {
  if (is_too_long() || task >= tasks_max || !path_.is_at_end()) return;
  look_around();
  if ((visit_state(the_barrier, asleep_ & ~task_bit(task)) & task_bit(task)) != 0) leave_as_redundant();
}

TaskBits ExhaustiveStrategy::visit_state(std::size_t runner, TaskBits asleep) noexcept {
  StateHash hash{world_.execution_number()};
  hash.add(world_.whole_state().hash());
  // How much of the bounds is left, and what it depends on.
  if (bounds_.preemptions) {
    hash.add(runner);
    hash.add(preemptions_);
  }
  if (bounds_.silences) {
    hash.add(silences_);
    hash.add(silent_);
    if (silent_ != 0) hash.add(silence_steps_ << 1U | (clock_was_used_ ? 1U : 0U));
  }
  return states_.visit(hash.value(), asleep);
}

SlowMoment ExhaustiveStrategy::slow_moment(const SlowMomentChoice& choice) noexcept {
  look_around();
  if (is_too_long() || choice.until_next_timer == VirtualClock::never || is_reduced()) return {};
  if (bounds_.silences && silent_ == 0 && silences_ >= *bounds_.silences) return {};
  const TaskBits held_up = able();
  if (held_up == 0) return {};
  if (bounds_.silences && silence_goes_on()) {
    // Who was woken takes his look first.
    if ((held_up & ~silent_) != 0) return {};
    if (!clock_was_used_ && silence_steps_ > bounds_.looks) {
      silent_ = 0;
      return {};
    }
  } else if (next_decision({.is_of_time = true, .chosen = 1, .count = 2}).chosen == 0) {
    return {};
  }
  if (bounds_.silences && silent_ == 0) {
    ++silences_;
    silence_steps_ = 0;
    silent_ = held_up;
  }
  clock_was_used_ = false;
  ++silence_steps_;
  polling_ = 0;
  return {.duration = std::max(choice.until_next_timer, SimTime{1})};
}

std::uint32_t ExhaustiveStrategy::decide_number(std::size_t count) noexcept {
  return next_decision({.count = static_cast<std::uint32_t>(count)}).chosen;
}

std::size_t ExhaustiveStrategy::strike(FaultKind kind, std::size_t variants_count) noexcept {
  look_around();
  if (is_too_long()) return 0;
  const std::uint32_t variant = decide_number(variants_count + 1);
  if (variant == 0) return 0;
  if (is_step_of_its_own(kind)) {
    add_barrier(false);
  } else if (acts_on_all(kind) && !steps_.empty()) {
    steps_.back().effect.is_barrier = true;
    wake_sleepers(steps_.back());
  }
  return variant;
}

std::size_t ExhaustiveStrategy::answer(std::size_t count) noexcept {
  return is_too_long() ? 0 : decide_number(count);
}

std::size_t ExhaustiveStrategy::choose_age(const AgeChoice& choice) noexcept {
  return is_too_long() ? 0 : decide_number(choice.ages.size());
}

void ExhaustiveStrategy::performs(TaskId task, const Operation& operation) noexcept {
  begin_step(task, operation, false);
  if (operation.kind == OperationKind::thread_create && world_.scheduler().tasks_count() < tasks_max) {
    follows_[world_.scheduler().tasks_count()] = steps_.size() - 1;
  } else if (operation.kind == OperationKind::thread_join && task < tasks_max) {
    awaits_join_ |= task_bit(task);
  }
}

void ExhaustiveStrategy::resumes(TaskId task, const Operation& operation) noexcept {
  begin_step(task, operation, true);
}

void ExhaustiveStrategy::only_looked() noexcept {
  if (!steps_.empty()) steps_.back().effect.looks = true;
}

void ExhaustiveStrategy::begin_step(std::size_t stepper, const Operation& operation,
                                    bool is_resumed) noexcept {
  look_around();
  if (is_too_long() || stepper >= tasks_max) return;  // of more tasks choose_task() has said so
  Step step{.stepper = stepper, .effect = {.operation = operation}};
  step.was_free = is_free(operation);
  step.decisions = path_.count_so_far();
  if (is_resumed) step.woken_by = woken_by_[stepper];
  step.follows = std::exchange(follows_[stepper], Step::none);
  if (is_resumed && operation.kind == OperationKind::thread_join) {
    const TaskId joined =
        World::task_of_join_key(world_.scheduler().task(static_cast<TaskId>(stepper)).wait_key);
    if (joined < tasks_max) step.follows = steps_.last_of(joined);
  }
  asleep_ &= ~task_bit(stepper);
  silent_ &= ~task_bit(stepper);
  if (is_more_than_a_look(operation.kind)) silence_steps_ = std::min(silence_steps_, 1U);
  clock_was_used_ = clock_was_used_ || uses_clock(operation.kind);
  polling_ &= ~task_bit(stepper);
  wake_sleepers(step);
  steps_.add(step);
}

void ExhaustiveStrategy::add_barrier(bool is_time) noexcept {
  Step step{.stepper = the_barrier, .effect = {.operation = {}, .looks = false, .is_barrier = true}};
  step.is_time = is_time;
  wake_sleepers(step);
  steps_.add(step);
}

void ExhaustiveStrategy::look_around() noexcept {
  if (is_too_long()) return;
  const Scheduler& scheduler = world_.scheduler();
  TaskBits blocked = 0;
  TaskBits joined = 0;
  const std::size_t tasks = std::min(scheduler.tasks_count(), tasks_max);
  for (std::size_t i = 0; i < tasks; ++i) {
    const Task& task = scheduler.task(static_cast<TaskId>(i));
    if (task.state == Task::State::blocked || task.state == Task::State::stalled) blocked |= task_bit(i);
    if (task.joined) joined |= task_bit(i);
  }
  const TaskBits woken = blocked_ & ~blocked;
  const std::uint32_t last = steps_.empty() ? Step::none : steps_.size() - 1;
  bool by_time = false;
  for (TaskBits all = woken; all != 0; all &= all - 1)
    by_time = by_time || scheduler.task(static_cast<TaskId>(std::countr_zero(all))).timed_out;
  // When nobody can run, time passes: after all that was, and before all that comes.
  if (by_time) add_barrier(true);
  for (TaskBits all = woken; all != 0; all &= all - 1)
    woken_by_[static_cast<std::size_t>(std::countr_zero(all))] = by_time ? steps_.last_of(the_barrier) : last;
  blocked_ = blocked;
  const TaskBits newly_joined = joined & ~joined_;
  if (newly_joined != 0 && last != Step::none && (awaits_join_ & task_bit(steps_.back().stepper)) != 0 &&
      steps_.back().stepper < tasks_max) {
    const auto of = static_cast<std::size_t>(std::countr_zero(newly_joined));
    follows_[steps_.back().stepper] = steps_.last_of(of);
    awaits_join_ &= ~task_bit(steps_.back().stepper);
  }
  joined_ = joined;
}

bool ExhaustiveStrategy::is_free(const Operation& operation) const noexcept {
  switch (operation.kind) {
    case OperationKind::mutex_lock:
    case OperationKind::mutex_trylock:
    case OperationKind::mutex_timedlock:
    case OperationKind::mutex_unlock:
    case OperationKind::cond_wait:
    case OperationKind::cond_timedwait:
      return world_.mutexes().owner_of(operation.object) == nullptr;
    case OperationKind::sem_wait:
    case OperationKind::sem_trywait:
    case OperationKind::sem_timedwait:
    case OperationKind::sem_post:
      return world_.semaphores().value_of(operation.object) != 0;
    default:
      return true;
  }
}

bool ExhaustiveStrategy::would_wait(std::size_t task) const noexcept {
  const Task& of = world_.scheduler().task(static_cast<TaskId>(task));
  const Operation& next = world_.scheduler().pending(of);
  if (next.kind == OperationKind::sem_wait) return !is_free(next);
  if (next.kind != OperationKind::mutex_lock) return false;
  const Task* const owner = world_.mutexes().owner_of(next.object);
  return owner != nullptr && owner != &of;
}

TaskBits ExhaustiveStrategy::able() const noexcept {
  TaskBits tasks = 0;
  for (std::size_t i = 0; i < std::min(world_.scheduler().tasks_count(), tasks_max); ++i) {
    if (world_.scheduler().task(static_cast<TaskId>(i)).state == Task::State::runnable && !would_wait(i))
      tasks |= task_bit(i);
  }
  return tasks;
}

StepEffect ExhaustiveStrategy::pending_of(std::size_t task) const noexcept {
  return {.operation = world_.scheduler().pending(world_.scheduler().task(static_cast<TaskId>(task)))};
}

void ExhaustiveStrategy::wake_sleepers(const Step& step) noexcept {
  if (step.effect.is_barrier || changes_what_others_see(step.effect.operation.kind) ||
      changes_memory(step.effect.operation.kind))
    polling_ &= step.stepper < tasks_max ? task_bit(step.stepper) : 0;
  for (TaskBits all = asleep_; all != 0; all &= all - 1) {
    const auto sleeper = static_cast<std::size_t>(std::countr_zero(all));
    if (steps_.depend(step, {.stepper = sleeper, .effect = pending_of(sleeper)}))
      asleep_ &= ~task_bit(sleeper);
  }
}

bool ExhaustiveStrategy::advance() {
  path_.end_execution();
  if (!trouble().empty()) return false;
  if (is_reduced()) steps_.find(path_);
  return path_.advance();
}

}  // namespace ltsim
