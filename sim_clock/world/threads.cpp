#include "sim_clock/world/threads.hpp"

#include <cerrno>

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {

int Threads::create(pthread_t* thread, bool detached, void* (*start)(void*), void* argument) noexcept {
  Scheduler& scheduler = world_.scheduler();
  scheduler.point({.kind = OperationKind::thread_create});
  const ProcessId process = current_task->process;
  Task& task =
      scheduler.create_task(process, fmt::format("thread-{}", world_.next_thread_number(process)), {});
  task.detached = detached;
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
