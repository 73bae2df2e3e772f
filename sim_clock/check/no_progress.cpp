#include "sim_clock/check/no_progress.hpp"

#include <array>

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

/// "sem_post handoff", "cond_signal"
std::string words(const World& world, const Operation& operation) {
  const std::string name = world.objects().name(operation);
  return fmt::format("{}{}{}", to_string(operation.kind), name == "-" ? "" : " ", name == "-" ? "" : name);
}

/// The task without which `task`, which is blocked, cannot go on; null if there is no one such task.
const Task* awaited_by(const World& world, const Task& task) {
  if (Mutexes::is_mutex_key(task.wait_key))
    return world.mutexes().owner_of(world.scheduler().pending(task).object);
  if (World::is_join_key(task.wait_key))
    return &world.scheduler().task(World::task_of_join_key(task.wait_key));
  return nullptr;
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
  const Task* const awaited = awaited_by(world, task);
  if (awaited == nullptr) {
    if (nobody_is_left) text += who_is_missing(operation.kind);
    return text;
  }
  text += fmt::format("{} {}", Mutexes::is_mutex_key(task.wait_key) ? ", held by" : " for", awaited->name);
  if (awaited->state == Task::State::finished) text += ", which has ended";
  if (awaited->state == Task::State::killed) text += ", which was killed";
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
      last = awaited_by(world, *last);
      ++length;
    } while (last != nullptr && last != &first && is_blocked(*last) && length < scheduler.tasks_count());
    if (last != &first) continue;
    text += fmt::format("{}a cycle of {}: ", text.empty() ? "" : "; ", length);
    const Task* member = &first;
    do {
      text += (member == &first ? "" : "; ") + tell(*member);
      member = awaited_by(world, *member);
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
