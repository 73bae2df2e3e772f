// How tasks begin and end.

#include <exception>
#include <utility>

#include <fmt/format.h>

#include "sim_clock/check/self_check.hpp"
#include "sim_clock/world/same_name.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {

void Scheduler::pool_tasks(std::size_t count) {
  while (tasks_.size() < count) {
    tasks_.push_back(std::make_unique<Task>());
    tasks_.back()->storage = std::make_unique<TaskStorage>();
  }
}

Task& Scheduler::create_task(ProcessId process, std::string_view name, std::function<void()> body) {
  if (tasks_count_ == tasks_max) {
    fail(OutcomeKind::unsupported, fmt::format("more than {} tasks in one world", tasks_max));
    return *tasks_.back();  // during set-up; nothing will run
  }
  pool_tasks(tasks_count_ + 1);
  Task& task = *tasks_[tasks_count_];
  const bool is_fresh = task.name.empty();
  set_name(task, process, name);
  for (std::size_t i = 0; i < tasks_count_; ++i) {
    if (!is_same_name(tasks_[i]->name, task.name)) continue;
    fail(OutcomeKind::unsupported,
         fmt::format("two tasks called {}: a schedule could not tell them apart", task.name));
    return *tasks_[i];  // during set-up; nothing will run
  }
  task.world = &world_;
  task.id = static_cast<TaskId>(tasks_count_++);
  task.process = process;
  task.timed_out = false;
  task.stands_at = {};
  task.is_held_up_at_point = false;
  task.detached = false;
  task.joined = false;
  pending_[task.id] = Operation{.kind = OperationKind::thread_start};
  task.priority = 0;
  task.effective_priority = 0;
  task.time_sharing = false;
  task.lends_to = VirtualClock::no_task;
  task.looked_at = Operation{};
  task.looks_count = 0;
  task.steps_since_look = 0;
  task.update_failed = false;
  task.polls.reset();
  task.repeats.reset();
  task.body = std::move(body);
  task.argument = nullptr;
  task.result = nullptr;
  task.body_frame = nullptr;
  task.traits = {};
  task.storage->reset();
  // A whole program may look at what nobody has written there: it finds the same each time. A fresh stack holds zeros, in pages that
  // nobody has touched: each of them costs a forked process a microsecond.
  if (!is_fresh && (decides_apart_ || ProgramMemory::is_on()))
    task.storage->clean_stack_below(task.storage->stack_top(), cleaned_at_begin);
  task.context.prepare(task.storage->stack_top(), task.storage->thread_pointer(), &run_task, &task);
  world_.checks().task_begins(task.id);
  ++unfinished_count_;
  ++unfinished_in_[process];
  make_runnable(task);
  return task;
}

void Scheduler::set_name(Task& task, ProcessId process, std::string_view name) {
  const std::string& process_name = world_.process_name(process);
  // Names do not repeat within an execution: the tasks of a process that was started again are others.
  const unsigned incarnation = world_.incarnation(process);
  const std::string_view pooled =
      task.name;  // the next execution mostly gives the same names in the same order
  const std::size_t slash = process_name.size();
  if (incarnation == 1 && pooled.size() == slash + 1 + name.size() && pooled[slash] == '/' &&
      is_same_name(pooled.substr(0, slash), process_name) && is_same_name(pooled.substr(slash + 1), name)) {
    return;
  }
  task.name.assign(process_name);
  if (incarnation != 1) task.name.append("@").append(std::to_string(incarnation));
  task.name.append("/").append(name);
  make_one_word(task.name);
}
namespace {

/// An exception that leaves the part ends the execution.
void run_part_of(Task& self, void (*part)(Task&)) noexcept {
  try {
    part(self);
  } catch (const std::exception& exception) {
    const GhostScope ghost;
    self.world->scheduler().fail(OutcomeKind::crash, fmt::format("{}: nobody caught the exception \"{}\"",
                                                                 self.name, exception.what()));
  } catch (...) {
    const GhostScope ghost;
    self.world->scheduler().fail(OutcomeKind::crash,
                                 fmt::format("{}: nobody caught an exception of an unknown type", self.name));
  }
}

}  // namespace

void Scheduler::run_task(void* argument) noexcept {
  Task& self = *static_cast<Task*>(argument);
  TaskStorage::finish_set_up_of_current();
  current_task = &self;
  run_part_of(self, &run_body);
  end_running();
}

// A frame of its own, which pthread_exit() can tell from those of the body: all of these lie below it.
[[gnu::noinline]] void Scheduler::run_body(Task& self) {
  self.body_frame = __builtin_frame_address(0);
  self.body();
  asm volatile("" ::: "memory");  // or the call of the body would be a jump, and this frame gone
}

void Scheduler::destroy_thread_locals(Task& self) {
  while (!self.thread_local_destructors.empty()) {
    const auto last = self.thread_local_destructors.back();
    self.thread_local_destructors.pop_back();
    last.destroy(last.object);
  }
}

void Scheduler::run_destructors(Task& self) {
  destroy_thread_locals(self);
  self.world->thread_specific().destroy_values(self);  // last, as with glibc
}

void Scheduler::end_running() noexcept {
  Task& self = *current_task;
  self.body_frame = nullptr;
  run_part_of(self, &run_destructors);
  self.world->scheduler().finish_running();
  LTSIM_UNREACHABLE("a finished task was resumed");
}

void Scheduler::finish_running() noexcept {
  Task& self = *running_;
  pending_[self.id] = Operation{.kind = OperationKind::thread_end};
  self.state = Task::State::finished;
  make_unrunnable(self);
  --unfinished_count_;
  --unfinished_in_[self.process];
  if (listener_ != nullptr) listener_->ends(self);
  mix(std::uint64_t{self.id} << 32U | 0xffU);
  world_.mutexes().owner_died(self.id);
  wake(World::join_key(self.id), tasks_max);
  leave(self);
}

}  // namespace ltsim
