#include "sim_clock/world/threads.hpp"

#include <sched.h>

#include <cerrno>

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

int Threads::create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                    void* argument) noexcept {
  const ThreadAttributes wanted = read(attributes, *current_task);
  Scheduler& scheduler = world_.scheduler();
  scheduler.point({.kind = OperationKind::thread_create});
  const ProcessId process = current_task->process;
  Task& task =
      scheduler.create_task(process, fmt::format("thread-{}", world_.next_thread_number(process)), {});
  world_.checks().follows(task.id, current_task->id);
  task.detached = wanted.detached;
  scheduler.set_priority(task, wanted.priority, wanted.time_sharing);
  task.body = [&task, start, argument] { task.result = start(argument); };
  *thread = reinterpret_cast<pthread_t>(task.storage->thread_pointer());  // what pthread_self() says there
  return 0;
}

int Threads::join(pthread_t thread, void** result) noexcept {
  Scheduler& scheduler = world_.scheduler();
  scheduler.point({.kind = OperationKind::thread_join});
  Task* const task = find(thread);
  if (task == nullptr || task->joined) return ESRCH;
  if (task->detached) return EINVAL;
  if (task == current_task) return EDEADLK;
  while (task->state != Task::State::finished)
    scheduler.block(World::join_key(task->id), VirtualClock::never);
  task->joined = true;
  world_.checks().follows(current_task->id, task->id);
  if (result != nullptr) *result = task->result;
  return 0;
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
