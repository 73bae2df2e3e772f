#include "sim_clock/world/threads.hpp"

#include <sched.h>

#include <cerrno>
#include <cstdint>

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {

namespace {

struct ThreadAttributes {
  bool detached = false;
  int priority = 0;
  bool time_sharing = false;
};

/// What pthread_create(3) makes of them: unless told otherwise a thread inherits its creator's priority.
ThreadAttributes read(const pthread_attr_t* attributes, const Task& creator) noexcept {
  ThreadAttributes result{.priority = creator.priority, .time_sharing = creator.time_sharing};
  if (attributes == nullptr) return result;
  int state = PTHREAD_CREATE_JOINABLE;
  pthread_attr_getdetachstate(attributes, &state);
  result.detached = state == PTHREAD_CREATE_DETACHED;
  int inherits = PTHREAD_INHERIT_SCHED;
  pthread_attr_getinheritsched(attributes, &inherits);
  if (inherits == PTHREAD_INHERIT_SCHED) return result;
  int policy = SCHED_OTHER;
  sched_param parameters{};
  pthread_attr_getschedpolicy(attributes, &policy);
  pthread_attr_getschedparam(attributes, &parameters);
  result.priority = parameters.sched_priority;
  result.time_sharing = policy == SCHED_RR;
  return result;
}

}  // namespace

Task& Threads::create_task(pthread_t* thread, const pthread_attr_t* attributes) noexcept {
  const ThreadAttributes wanted = read(attributes, *current_task);
  Scheduler& scheduler = world_.scheduler();
  scheduler.point({.kind = OperationKind::thread_create});
  const ProcessId process = current_task->process;
  Task& task =
      scheduler.create_task(process, fmt::format("thread-{}", world_.next_thread_number(process)), {});
  world_.checks().follows(task.id, current_task->id);
  world_.signals().inherit_mask(task.id, current_task->id);
  task.detached = wanted.detached;
  scheduler.set_priority(task, wanted.priority, wanted.time_sharing);
  task.traits.name = current_task->traits.name;
  task.traits.processors = current_task->traits.processors;
  *thread = reinterpret_cast<pthread_t>(task.storage->thread_pointer());  // what pthread_self() says there
  return task;
}

int Threads::create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                    void* argument) noexcept {
  Task& task = create_task(thread, attributes);
  task.argument = argument;
  task.body = [&task, start, argument] { task.result = start(argument); };
  return 0;
}

int Threads::create(pthread_t* thread, int (*start)(void*), void* argument) noexcept {
  Task& task = create_task(thread, nullptr);
  task.argument = argument;
  task.body = [&task, start, argument] {
    task.result = reinterpret_cast<void*>(static_cast<std::intptr_t>(start(argument)));
  };
  return 0;
}

int Threads::join(pthread_t thread, void** result) noexcept {
  return join_before(thread, result, OperationKind::thread_join, VirtualClock::never);
}

int Threads::timed_join(pthread_t thread, void** result, Deadline deadline) noexcept {
  return join_before(thread, result, OperationKind::thread_timedjoin, deadline);
}

int Threads::join_before(pthread_t thread, void** result, OperationKind kind, Deadline deadline) noexcept {
  Scheduler& scheduler = world_.scheduler();
  scheduler.point({.kind = kind});
  Task* const task = find(thread);
  if (const int error = check_joinable(task); error != 0) return error;
  if (task == current_task) return EDEADLK;
  while (task->state != Task::State::finished) {
    if (scheduler.block(World::join_key(task->id), deadline) == Scheduler::Wake::timed_out &&
        task->state != Task::State::finished) {
      return ETIMEDOUT;
    }
  }
  has_ended(*task, result);
  return 0;
}

int Threads::try_join(pthread_t thread, void** result) noexcept {
  world_.scheduler().point({.kind = OperationKind::thread_tryjoin});
  Task* const task = find(thread);
  if (const int error = check_joinable(task); error != 0) return error;
  if (task->state != Task::State::finished) {
    world_.scheduler().only_looked();
    return EBUSY;
  }
  has_ended(*task, result);
  return 0;
}

int Threads::check_joinable(const Task* task) noexcept {
  if (task == nullptr || task->joined) return ESRCH;
  return task->detached ? EINVAL : 0;
}

void Threads::has_ended(Task& task, void** result) noexcept {
  task.joined = true;
  world_.checks().follows(current_task->id, task.id);
  if (result != nullptr) *result = task.result;
}

int Threads::detach(pthread_t thread) noexcept {
  Task* const task = find(thread);
  if (task == nullptr || task->joined) return ESRCH;
  if (task->detached) return EINVAL;
  task->detached = true;
  return 0;
}

Task* Threads::find(pthread_t thread) noexcept {
  Scheduler& scheduler = world_.scheduler();
  for (std::size_t i = 0; i < scheduler.tasks_count(); ++i) {
    Task& task = scheduler.task(static_cast<TaskId>(i));
    if (reinterpret_cast<pthread_t>(task.storage->thread_pointer()) == thread) return &task;
  }
  return nullptr;
}

}  // namespace ltsim
