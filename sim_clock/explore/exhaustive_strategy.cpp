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
      return true;
    default:
      return false;
  }
}

}  // namespace

void ExhaustiveStrategy::begin_execution(std::uint64_t /*seed*/) noexcept {
  at_ = 0;
  asleep_ = polling_ = blocked_ = awaits_join_ = joined_ = 0;
  preemptions_ = silences_ = silence_steps_ = 0;
  silent_ = 0;
  clock_was_used_ = false;
  events_.clear();
  last_of_.assign(steppers_count, none);
  woken_by_.assign(steppers_count, none);
  follows_.assign(steppers_count, none);
  is_redundant_ = is_cut_off_ = is_held_back_ = false;
}

ExhaustiveStrategy::Decision& ExhaustiveStrategy::next_decision(const Decision& as_new) noexcept {
  if (at_ == path_.size()) {
    path_.push_back(as_new);
    path_.back().events = static_cast<std::uint32_t>(events_.size());
  } else {
    const Decision& known = path_[at_];
    if (known.is_of_tasks != as_new.is_of_tasks || known.is_of_time != as_new.is_of_time ||
        known.enabled != as_new.enabled || known.count != as_new.count) {
      note_that_runs_differ();
      path_.resize(at_);
      path_.push_back(as_new);
      path_.back().events = static_cast<std::uint32_t>(events_.size());
      if (as_new.is_of_tasks)
        path_.back().chosen = static_cast<std::uint32_t>(std::countr_zero(as_new.enabled));
    }
  }
  return path_[at_++];
}

void ExhaustiveStrategy::note_that_runs_differ() {
  if (!trouble_.empty()) return;
  trouble_ = fmt::format(
      "an execution that is run again differs at choice {}: a variable of the code under test or of the "
      "scenario survives from one execution to the next",
      at_ + 1);
}

void ExhaustiveStrategy::leave() noexcept {
  const GhostScope ghost;
  world_.scheduler().abandon();
}

std::size_t ExhaustiveStrategy::choose_task(const TaskChoice& choice) noexcept {
  if (is_too_long()) return 0;
  look_around();
  Tasks enabled = 0;
  for (const std::uint64_t option : choice.options) {
    if (option >= tasks_max) {
      trouble_ = fmt::format("more than {} tasks: not every order of so many can be tried", tasks_max);
      leave();
      return 0;
    }
    enabled |= bit(option);
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
  Tasks waiting = 0;
  for (const std::uint64_t option : choice.options) {
    if (would_wait(option)) waiting |= bit(option);
  }
  // If all would, they do.
  if (waiting == enabled) return 0;
  enabled &= ~waiting;
  // Who took the last step; the one who runs may only have come to his first.
  const std::size_t runner = events_.empty() ? the_barrier : events_.back().stepper;
  const bool goes_on = (enabled & bit(runner)) != 0 && !contains(choice.under_way, runner);
  if (goes_on && world_.scheduler().task(static_cast<TaskId>(runner)).looks_count >= bounds_.looks)
    polling_ |= bit(runner);
  if (silence_goes_on() && (enabled & ~silent_) != 0) enabled &= ~silent_;
  Tasks candidates = enabled & ~polling_;
  is_held_back_ = is_held_back_ || (candidates != 0 && candidates != enabled);
  if (candidates == 0) candidates = enabled;
  Decision as_new{.is_of_tasks = true, .enabled = enabled};
  const bool is_new = at_ == path_.size();
  if (is_new) {
    const bool can_be_preempted = goes_on && (candidates & bit(runner)) != 0;
    if (bounds_.preemptions) {
      as_new.to_try = can_be_preempted && preemptions_ >= *bounds_.preemptions ? bit(runner) : candidates;
    } else {
      as_new.asleep = asleep_;
      candidates &= ~asleep_;
      if (candidates == 0) {
        // Those who wait race with who took what they wait for: they might have come first.
        for (Tasks all = waiting; all != 0; all &= all - 1) {
          const auto task = static_cast<std::size_t>(std::countr_zero(all));
          Event waits{.stepper = task, .effect = pending_of(task)};
          waits.was_free = false;
          events_.push_back(waits);
        }
        is_redundant_ = true;
        leave();
        return 0;
      }
    }
    const Tasks first = bounds_.preemptions ? as_new.to_try : candidates;
    as_new.chosen = static_cast<std::uint32_t>((first & bit(runner)) != 0 ? runner : std::countr_zero(first));
    as_new.to_try |= bit(as_new.chosen);
  }
  const Decision& decision = next_decision(as_new);
  asleep_ = (decision.asleep | decision.tried) & ~bit(decision.chosen);
  if (bounds_.preemptions) asleep_ = 0;
  if (goes_on && (polling_ & bit(runner)) == 0 && decision.chosen != runner) ++preemptions_;
  return index_of(decision.chosen);
}

SlowMoment ExhaustiveStrategy::slow_moment(const SlowMomentChoice& choice) noexcept {
  look_around();
  if (is_too_long() || choice.until_next_timer == VirtualClock::never || !bounds_.preemptions) return {};
  if (silent_ == 0 && silences_ >= bounds_.silences) return {};
  const Tasks held_up = able();
  if (held_up == 0) return {};
  if (silence_goes_on()) {
    // Who was woken takes his look first.
    if ((held_up & ~silent_) != 0) return {};
    if (!clock_was_used_ && silence_steps_ > bounds_.looks) {
      silent_ = 0;
      return {};
    }
  } else if (next_decision({.is_of_time = true, .chosen = 1, .count = 2}).chosen == 0) {
    return {};
  }
  if (silent_ == 0) {
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
  } else if (acts_on_all(kind) && !events_.empty()) {
    events_.back().effect.is_barrier = true;
    wake_sleepers(events_.back());
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
  begin_event(task, operation, false);
  if (operation.kind == OperationKind::thread_create && world_.scheduler().tasks_count() < tasks_max) {
    follows_[world_.scheduler().tasks_count()] = static_cast<std::uint32_t>(events_.size() - 1);
  } else if (operation.kind == OperationKind::thread_join && task < tasks_max) {
    awaits_join_ |= bit(task);
  }
}

void ExhaustiveStrategy::resumes(TaskId task, const Operation& operation) noexcept {
  begin_event(task, operation, true);
}

void ExhaustiveStrategy::only_looked() noexcept {
  if (!events_.empty()) events_.back().effect.looks = true;
}

void ExhaustiveStrategy::begin_event(std::size_t stepper, const Operation& operation,
                                     bool is_resumed) noexcept {
  look_around();
  if (is_too_long() || stepper >= tasks_max) return;  // of more tasks choose_task() has said so
  Event event{.stepper = stepper, .effect = {.operation = operation}};
  event.was_free = is_free(operation);
  event.decisions = static_cast<std::uint32_t>(at_);
  if (is_resumed) event.woken_by = woken_by_[stepper];
  event.follows = std::exchange(follows_[stepper], none);
  if (is_resumed && operation.kind == OperationKind::thread_join) {
    const TaskId joined =
        World::task_of_join_key(world_.scheduler().task(static_cast<TaskId>(stepper)).wait_key);
    if (joined < tasks_max) event.follows = last_of_[joined];
  }
  asleep_ &= ~bit(stepper);
  silent_ &= ~bit(stepper);
  if (is_more_than_a_look(operation.kind)) silence_steps_ = std::min(silence_steps_, 1U);
  clock_was_used_ = clock_was_used_ || uses_clock(operation.kind);
  polling_ &= ~bit(stepper);
  wake_sleepers(event);
  last_of_[stepper] = static_cast<std::uint32_t>(events_.size());
  events_.push_back(event);
}

void ExhaustiveStrategy::add_barrier(bool is_time) noexcept {
  Event event{.stepper = the_barrier, .effect = {.operation = {}, .looks = false, .is_barrier = true}};
  event.is_time = is_time;
  wake_sleepers(event);
  last_of_[the_barrier] = static_cast<std::uint32_t>(events_.size());
  events_.push_back(event);
}

void ExhaustiveStrategy::look_around() noexcept {
  if (is_too_long()) return;
  const Scheduler& scheduler = world_.scheduler();
  Tasks blocked = 0;
  Tasks joined = 0;
  const std::size_t tasks = std::min(scheduler.tasks_count(), tasks_max);
  for (std::size_t i = 0; i < tasks; ++i) {
    const Task& task = scheduler.task(static_cast<TaskId>(i));
    if (task.state == Task::State::blocked || task.state == Task::State::stalled) blocked |= bit(i);
    if (task.joined) joined |= bit(i);
  }
  const Tasks woken = blocked_ & ~blocked;
  const auto last = events_.empty() ? none : static_cast<std::uint32_t>(events_.size() - 1);
  bool by_time = false;
  for (Tasks all = woken; all != 0; all &= all - 1)
    by_time = by_time || scheduler.task(static_cast<TaskId>(std::countr_zero(all))).timed_out;
  // When nobody can run, time passes: after all that was, and before all that comes.
  if (by_time) add_barrier(true);
  for (Tasks all = woken; all != 0; all &= all - 1)
    woken_by_[static_cast<std::size_t>(std::countr_zero(all))] = by_time ? last_of_[the_barrier] : last;
  blocked_ = blocked;
  const Tasks newly_joined = joined & ~joined_;
  if (newly_joined != 0 && last != none && (awaits_join_ & bit(events_[last].stepper)) != 0 &&
      events_[last].stepper < tasks_max) {
    const auto of = static_cast<std::size_t>(std::countr_zero(newly_joined));
    follows_[events_[last].stepper] = last_of_[of];
    awaits_join_ &= ~bit(events_[last].stepper);
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

ExhaustiveStrategy::Tasks ExhaustiveStrategy::able() const noexcept {
  Tasks tasks = 0;
  for (std::size_t i = 0; i < std::min(world_.scheduler().tasks_count(), tasks_max); ++i) {
    if (world_.scheduler().task(static_cast<TaskId>(i)).state == Task::State::runnable && !would_wait(i))
      tasks |= bit(i);
  }
  return tasks;
}

StepEffect ExhaustiveStrategy::pending_of(std::size_t task) const noexcept {
  return {.operation = world_.scheduler().pending(world_.scheduler().task(static_cast<TaskId>(task)))};
}

void ExhaustiveStrategy::wake_sleepers(const Event& event) noexcept {
  if (event.effect.is_barrier || changes_what_others_see(event.effect.operation.kind) ||
      changes_memory(event.effect.operation.kind))
    polling_ &= event.stepper < tasks_max ? bit(event.stepper) : 0;
  for (Tasks all = asleep_; all != 0; all &= all - 1) {
    const auto sleeper = static_cast<std::size_t>(std::countr_zero(all));
    if (depend(event, {.stepper = sleeper, .effect = pending_of(sleeper)})) asleep_ &= ~bit(sleeper);
  }
}

bool ExhaustiveStrategy::depend(const Event& one, const Event& other) const noexcept {
  return one.stepper == other.stepper ||
         order_matters(one.effect, other.effect, world_.memory() == Memory::c11);
}

void ExhaustiveStrategy::find_races() {
  // What came before the last decision was looked at when it was new.
  clocks_.resize(events_.size() * steppers_count);
  std::fill(clocks_.begin() + static_cast<std::ptrdiff_t>(replayed_events_ * steppers_count), clocks_.end(),
            0);
  std::vector<std::uint32_t> last(steppers_count, none);
  for (std::uint32_t n = 0; n < events_.size(); ++n) {
    const Event& event = events_[n];
    if (n < replayed_events_) {
      last[event.stepper] = n;
      continue;
    }
    std::uint32_t* const clock = clock_of(n);
    const auto join = [&](std::uint32_t earlier) {
      const std::uint32_t* const other = clock_of(earlier);
      for (std::size_t i = 0; i < steppers_count; ++i) clock[i] = std::max(clock[i], other[i]);
    };
    if (last[event.stepper] != none) join(last[event.stepper]);
    if (event.follows != none) join(event.follows);
    if (event.woken_by != none) join(event.woken_by);
    // Where the two cannot change places, perhaps `event` can come before what came earlier still: who takes something cannot
    // come before it was given back, but before the one who took it then.
    const bool takes = event.effect.operation.kind == OperationKind::sem_wait ||
                       event.effect.operation.kind == OperationKind::mutex_lock;
    bool is_free_here = event.was_free;
    but_for_fixed_.assign(clock, clock + steppers_count);
    for (std::uint32_t e = n; e-- > 0;) {
      const Event& earlier = events_[e];
      if (takes && earlier.effect.operation.object == event.effect.operation.object)
        is_free_here = earlier.was_free;
      if (but_for_fixed_[earlier.stepper] > e || !depend(earlier, event)) continue;
      const bool is_fixed = event.is_time || (takes && !is_free_here) || !reverse(e, n);
      join(e);
      if (is_fixed) continue;
      const std::uint32_t* const other = clock_of(e);
      for (std::size_t i = 0; i < steppers_count; ++i)
        but_for_fixed_[i] = std::max(but_for_fixed_[i], other[i]);
    }
    clock[event.stepper] = n + 1;
    last[event.stepper] = n;
  }
}

bool ExhaustiveStrategy::reverse(std::uint32_t earlier, std::uint32_t later) {
  // Who can begin what did not have to come after `earlier`, and ends with `later`.
  Tasks begins = 0;
  Tasks seen = 0;
  std::vector<std::uint32_t> rest;
  for (std::uint32_t e = earlier + 1; e <= later; ++e) {
    const bool comes_after = e != later && happens_before(earlier, e);
    if (comes_after) continue;
    const std::size_t stepper = events_[e].stepper;
    if ((seen & bit(stepper)) == 0) {
      const bool has_predecessor = std::any_of(rest.begin(), rest.end(), [&](std::uint32_t other) {
        return e == later ? clock_of(later)[events_[other].stepper] > other : happens_before(other, e);
      });
      if (!has_predecessor) begins |= bit(stepper);
    }
    seen |= bit(stepper);
    rest.push_back(e);
  }
  // Faults strike wherever they can.
  if ((begins & bit(the_barrier)) != 0) return true;
  // There, or where one of them could last be chosen: what has happened in between does not matter to it.
  for (std::uint32_t d = events_[earlier].decisions; d-- > 0;) {
    Decision& decision = path_[d];
    if (!decision.is_of_tasks) continue;
    if ((begins & (decision.to_try | decision.asleep)) != 0) return true;
    const Tasks possible = begins & decision.enabled;
    decision.to_try |= possible & (0 - possible);
    if (possible != 0) return true;
  }
  return false;
}

bool ExhaustiveStrategy::advance() {
  if (at_ < path_.size()) note_that_runs_differ();
  if (!trouble_.empty()) return false;
  if (!bounds_.preemptions) find_races();
  while (!path_.empty()) {
    Decision& last = path_.back();
    if (last.is_of_tasks) {
      last.tried |= bit(last.chosen);
      const Tasks left = last.to_try & ~last.tried & ~last.asleep;
      if (left != 0) {
        last.chosen = static_cast<std::uint32_t>(std::countr_zero(left));
        break;
      }
    } else if (last.is_of_time) {
      if (last.chosen == 1) {
        last.chosen = 0;
        break;
      }
    } else if (last.chosen + 1 < last.count) {
      ++last.chosen;
      break;
    }
    path_.pop_back();
  }
  if (path_.empty()) return false;
  // A number is chosen in the middle of a step, which it may make another.
  const Decision& changed = path_.back();
  replayed_events_ =
      changed.events - (changed.is_of_tasks || changed.is_of_time || changed.events == 0 ? 0 : 1);
  return true;
}

double ExhaustiveStrategy::done() const noexcept {
  double done = 0;
  double share = 1;
  for (const Decision& decision : path_) {
    double all = 2;
    double before = 0;
    if (decision.is_of_tasks) {
      all = std::popcount(decision.to_try & ~decision.asleep);
      before = std::popcount(decision.tried & decision.to_try);
    } else if (decision.is_of_time) {
      before = decision.chosen == 1 ? 0 : 1;
    } else {
      all = decision.count;
      before = decision.chosen;
    }
    if (all < 1) continue;
    done += share * before / all;
    share /= all;
  }
  return done;
}

std::string ExhaustiveStrategy::checkpoint() const {
  std::string text;
  for (const Decision& decision : path_) {
    if (decision.is_of_tasks) {
      text += fmt::format("task {} of {:#x} to-try {:#x} tried {:#x} asleep {:#x}\n", decision.chosen,
                          decision.enabled, decision.to_try, decision.tried, decision.asleep);
    } else {
      text += fmt::format("{} {} of {}\n", decision.is_of_time ? "time" : "number", decision.chosen,
                          decision.count);
    }
  }
  return text;
}

bool ExhaustiveStrategy::resume(std::string_view checkpoint) {
  path_.clear();
  while (!checkpoint.empty()) {
    const std::string line{checkpoint.substr(0, checkpoint.find('\n'))};
    checkpoint.remove_prefix(std::min(line.size() + 1, checkpoint.size()));
    Decision decision;
    unsigned long long enabled = 0, to_try = 0, tried = 0, asleep = 0;
    if (std::sscanf(line.c_str(), "task %u of %llx to-try %llx tried %llx asleep %llx", &decision.chosen,
                    &enabled, &to_try, &tried, &asleep) == 5) {
      decision.is_of_tasks = true;
      decision.enabled = enabled;
      decision.to_try = to_try;
      decision.tried = tried;
      decision.asleep = asleep;
    } else if (std::sscanf(line.c_str(), "time %u of %u", &decision.chosen, &decision.count) == 2) {
      decision.is_of_time = true;
    } else if (std::sscanf(line.c_str(), "number %u of %u", &decision.chosen, &decision.count) != 2) {
      return false;
    }
    path_.push_back(decision);
  }
  replayed_events_ = 0;
  return true;
}

}  // namespace ltsim
