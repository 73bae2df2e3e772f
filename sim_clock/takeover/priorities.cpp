// Priorities of threads, sched(7). They are kept in every world and matter on Cpu::one_fifo.

#include <pthread.h>
#include <sched.h>

#include <cerrno>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

namespace {

/// @return whether Linux takes the two together
bool is_valid(int policy, int priority) noexcept {
  const bool is_real_time = policy == SCHED_FIFO || policy == SCHED_RR;
  const bool is_other = policy == SCHED_OTHER || policy == SCHED_BATCH || policy == SCHED_IDLE;
  return is_real_time ? priority >= 1 && priority <= 99 : is_other && priority == 0;
}

int set_priority(ltsim::Task* task, int policy, int priority) noexcept {
  if (task == nullptr) return ESRCH;
  if (!is_valid(policy, priority)) return EINVAL;
  current_task->world->scheduler().set_priority(*task, priority, policy == SCHED_RR);
  return 0;
}

int policy_of(const ltsim::Task& task) noexcept {
  if (task.priority == 0) return SCHED_OTHER;
  return task.time_sharing ? SCHED_RR : SCHED_FIFO;
}

ltsim::Task* find(pthread_t thread) noexcept { return current_task->world->threads().find(thread); }

/// The calls with a process id mean the calling thread with 0; others are not simulated.
/// @return 0 or -1 with errno
int as_system_call(int error) noexcept {
  if (error == 0) return 0;
  errno = error;
  return -1;
}

ltsim::Task* task_of_process_id(pid_t id) noexcept { return id == 0 ? current_task : nullptr; }

}  // namespace

extern "C" int pthread_setschedparam(pthread_t thread, int policy, const sched_param* parameters) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_setschedparam)(thread, policy, parameters);
  return set_priority(find(thread), policy, parameters->sched_priority);
}

extern "C" int pthread_setschedprio(pthread_t thread, int priority) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_setschedprio)(thread, priority);
  ltsim::Task* const task = find(thread);
  return set_priority(task, task == nullptr ? SCHED_OTHER : policy_of(*task), priority);
}

extern "C" int pthread_getschedparam(pthread_t thread, int* policy, sched_param* parameters) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_getschedparam)(thread, policy, parameters);
  const ltsim::Task* const task = find(thread);
  if (task == nullptr) return ESRCH;
  *policy = policy_of(*task);
  parameters->sched_priority = task->priority;
  return 0;
}

extern "C" int sched_setscheduler(pid_t id, int policy, const sched_param* parameters) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(sched_setscheduler)(id, policy, parameters);
  return as_system_call(set_priority(task_of_process_id(id), policy, parameters->sched_priority));
}

extern "C" int sched_setparam(pid_t id, const sched_param* parameters) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(sched_setparam)(id, parameters);
  ltsim::Task* const task = task_of_process_id(id);
  return as_system_call(
      set_priority(task, task == nullptr ? SCHED_OTHER : policy_of(*task), parameters->sched_priority));
}

extern "C" int sched_getscheduler(pid_t id) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(sched_getscheduler)(id);
  const ltsim::Task* const task = task_of_process_id(id);
  return task == nullptr ? as_system_call(ESRCH) : policy_of(*task);
}

extern "C" int sched_getparam(pid_t id, sched_param* parameters) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(sched_getparam)(id, parameters);
  const ltsim::Task* const task = task_of_process_id(id);
  if (task == nullptr) return as_system_call(ESRCH);
  parameters->sched_priority = task->priority;
  return 0;
}
