#include "sim_clock/check/no_progress.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

/// "sem_post handoff", "cond_signal"
std::string words(const World& world, const Operation& operation) {
  const std::string name = world.objects().name(operation);
  return fmt::format("{}{}{}", to_string(operation.kind), name == "-" ? "" : " ", name == "-" ? "" : name);
}

/// The tasks without which `task`, which is blocked, cannot go on; none if that is nobody in particular.
std::vector<const Task*> awaited_by(const World& world, const Task& task) {
  if (World::is_join_key(task.wait_key))
    return {&world.scheduler().task(World::task_of_join_key(task.wait_key))};
  const ObjectId object = world.scheduler().pending(task).object;
  const Task* owner = nullptr;
  if (Mutexes::is_mutex_key(task.wait_key)) {
    owner = world.mutexes().owner_of(object);
  } else {
    switch (world.scheduler().pending(task).kind) {
      case OperationKind::rwlock_rdlock:
      case OperationKind::rwlock_timedrdlock:
      case OperationKind::rwlock_wrlock:
      case OperationKind::rwlock_timedwrlock: {
        std::vector<const Task*> holders;
        for (const TaskId holder : world.rwlocks().holders_of(object))
          holders.push_back(&world.scheduler().task(holder));
        return holders;
      }
      case OperationKind::spin_lock:
        owner = world.spin_locks().owner_of(object);
        break;
      case OperationKind::static_init:
        owner = world.static_guards().owner_of(object);
        break;
      default:
        break;
    }
  }
  return owner == nullptr ? std::vector<const Task*>{} : std::vector{owner};
}

/// The one of them by which a circle may close; null: none.
const Task* next_in_circle(const World& world, const Task& task) {
  const auto all = awaited_by(world, task);
  const auto blocked = std::find_if(
      all.begin(), all.end(), [](const Task* awaited) { return awaited->state == Task::State::blocked; });
  if (blocked != all.end()) return *blocked;
  return all.empty() ? nullptr : all.front();
}

std::string_view who_is_missing(OperationKind kind) noexcept {
  switch (kind) {
    case OperationKind::sem_wait:
    case OperationKind::sem_timedwait:
      return ", and nobody is left to post it";
    case OperationKind::cond_wait:
    case OperationKind::cond_timedwait:
      return ", and nobody is left to signal its condition";
    case OperationKind::futex_wait:
      return ", and nobody is left to wake it";
    default:
      return "";
  }
}

/// @param nobody_is_left  whether what it waits for cannot come any more
std::string waiting(const World& world, const Task& task, bool nobody_is_left) {
  const Operation& operation = world.scheduler().pending(task);
  std::string text = fmt::format("{} waits in {}", task.name, words(world, operation));
  if (operation.kind == OperationKind::barrier_wait)
    text += fmt::format(", where {}", world.barriers().describe(operation.object));
  const auto awaited = awaited_by(world, task);
  if (awaited.empty() && nobody_is_left) text += who_is_missing(operation.kind);
  std::string_view before = World::is_join_key(task.wait_key)              ? " for"
                            : operation.kind == OperationKind::static_init ? ", at which is"
                                                                           : ", held by";
  for (const Task* const each : awaited) {
    text += fmt::format("{} {}", before, each->name);
    if (each->state == Task::State::finished) text += ", which has ended";
    if (each->state == Task::State::killed) text += ", which was killed";
    before = " and by";
  }
  return text;
}

}  // namespace

std::string describe_deadlock(const World& world) {
  const Scheduler& scheduler = world.scheduler();
  const auto is_blocked = [](const Task& task) { return task.state == Task::State::blocked; };
  std::array<bool, tasks_max> told{};
  std::string text;
  const auto tell = [&](const Task& task) {
    told[task.id] = true;
    return waiting(world, task, true);
  };
  for (std::size_t i = 0; i < scheduler.tasks_count(); ++i) {
    const Task& first = scheduler.task(static_cast<TaskId>(i));
    if (told[i] || !is_blocked(first)) continue;
    const Task* last = &first;
    std::size_t length = 0;
    do {
      last = next_in_circle(world, *last);
      ++length;
    } while (last != nullptr && last != &first && is_blocked(*last) && length < scheduler.tasks_count());
    if (last != &first) continue;
    text += fmt::format("{}a cycle of {}: ", text.empty() ? "" : "; ", length);
    const Task* member = &first;
    do {
      text += (member == &first ? "" : "; ") + tell(*member);
      member = next_in_circle(world, *member);
    } while (member != &first);
  }
  for (std::size_t i = 0; i < scheduler.tasks_count(); ++i) {
    const Task& task = scheduler.task(static_cast<TaskId>(i));
    if (!told[i] && is_blocked(task)) text += (text.empty() ? "" : "; ") + tell(task);
  }
  return text;
}

std::string describe_livelock(const World& world) {
  const Scheduler& scheduler = world.scheduler();
  std::string text;
  for (std::size_t i = 0; i < scheduler.tasks_count(); ++i) {
    const Task& task = scheduler.task(static_cast<TaskId>(i));
    if (task.state == Task::State::finished || task.state == Task::State::killed) continue;
    text += text.empty() ? "" : "; ";
    if (task.state == Task::State::blocked && task.deadline == VirtualClock::never) {
      text += waiting(world, task, false);
    } else if (task.repeats) {
      text += fmt::format("{} repeats {}", task.name, words(world, *task.repeats));
    } else if (task.polls) {
      text += fmt::format("{} polls {}", task.name, words(world, *task.polls));
    } else {
      text += fmt::format("{} lets time pass", task.name);
    }
  }
  return text;
}

}  // namespace ltsim
