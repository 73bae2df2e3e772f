// The scheduler's part in telling states apart (whole_state.hpp): tasks stand still while the strategy chooses among them, and what
// it holds of the state.

#include <algorithm>

#include "sim_clock/world/heap.hpp"
#include "sim_clock/world/state_hash.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

/// What a task waits for may be an address, with marks in the highest bits.
void add_key(StateHash& hash, WaitKey key) noexcept {
  constexpr unsigned address_bits = 48;
  hash.add(key >> address_bits);
  hash.add_word(key & ((WaitKey{1} << address_bits) - 1));
}

}  // namespace

TaskId Scheduler::decide_apart() noexcept {
  // Wherever a task stands in a world whose states are looked at, it stands here, so that it looks the same.
  Context::switch_between(running_->context, decider_context_);
  return running_->id;
}

void Scheduler::run_decider(void* scheduler) noexcept {
  auto& self = *static_cast<Scheduler*>(scheduler);
  for (;;) {
    const Task& stands = *self.running_;
    stands.storage->clean_stack_below(stands.context.stack_pointer(), cleaned_at_each_stop);
    std::size_t chosen = 0;
    {
      const Heap::Pause pause;
      if (self.choice_.options.size() > 1) {
        chosen = self.strategy_->choose_task(self.choice_);
      } else {
        self.strategy_->only_one_can_run(static_cast<TaskId>(self.choice_.options[0]));
      }
    }
    self.running_ = self.tasks_[self.choice_.options[chosen]].get();
    if (self.running_ != &stands) self.others_ran_ = true;
    Context::switch_between(self.decider_context_, self.running_->context);
  }
}

// Not in it: whether others ran while the running task stood at its point. That only spares it a second look at a mapping, and what
// is mapped goes in.
void Scheduler::add_state(StateHash& hash) const noexcept {
  hash.add(static_cast<std::uint64_t>(clock_.now().count()));
  hash.add(std::uint64_t{time_has_mattered()} << 32U | tasks_count_);
  for (std::size_t i = 0; i < tasks_count_; ++i) {
    const Task& task = *tasks_[i];
    if (task.state == Task::State::killed) {
      // It does nothing more, and only its own process could have waited for it: where it stood makes no difference.
      hash.add(static_cast<std::uint64_t>(task.state));
      continue;
    }
    const bool is_under_way = (under_way_[i / 64] >> i % 64 & 1U) != 0;
    // How block() ended is asked as soon as the task goes on, and never again.
    hash.add(static_cast<std::uint64_t>(task.state) | std::uint64_t{task.timed_out && is_under_way} << 8U |
             std::uint64_t{is_under_way} << 11U | std::uint64_t{task.is_held_up_at_point} << 12U |
             std::uint64_t{task.detached} << 9U | std::uint64_t{task.joined} << 10U);
    hash.add_word(reinterpret_cast<std::uintptr_t>(task.result));
    if (task.state == Task::State::finished) continue;
    hash.add(static_cast<std::uint64_t>(clock_.deadline_of(task.id).count()));
    if (task.state == Task::State::blocked) {
      add_key(hash, task.wait_key);
      hash.add(static_cast<std::uint64_t>(task.deadline.count()) << 1U |
               std::uint64_t{task.deadline_on_wall_clock});
      hash.add(static_cast<std::uint64_t>(std::count_if(
          tasks_.begin(), tasks_.begin() + static_cast<std::ptrdiff_t>(tasks_count_), [&](const auto& other) {
            return other->state == Task::State::blocked && other->wait_key == task.wait_key &&
                   other->blocked_since < task.blocked_since;
          })));
    }
    hash.add(task.thread_local_destructors.size());
    for (const auto& [destroy, object] : task.thread_local_destructors) {
      hash.add(reinterpret_cast<std::uintptr_t>(destroy));
      hash.add_word(reinterpret_cast<std::uintptr_t>(object));
    }
    hash.add(task.cleanup_buffers.size());
    for (const void* const buffer : task.cleanup_buffers)
      hash.add_word(reinterpret_cast<std::uintptr_t>(buffer));
    hash.add_memory(task.traits.name.data(), task.traits.name.size());
    hash.add(static_cast<std::uint64_t>(task.traits.cancel_state) << 32U |
             static_cast<std::uint64_t>(task.traits.cancel_type));
    hash.add(task.traits.processors);
    hash.add_memory(&task.body, sizeof task.body);
    const auto* const top = static_cast<const std::byte*>(task.storage->stack_top());
    const auto* stack = static_cast<const std::byte*>(task.stands_at.stack_pointer);
    if (stack != nullptr) {
      hash.add_memory(&task.stands_at, sizeof task.stands_at);
    } else {  // it has not begun
      const auto registers = task.context.registers();
      hash.add_memory(registers.data(), registers.size());
      stack = static_cast<const std::byte*>(task.context.stack_pointer());
    }
    hash.add_memory(stack, static_cast<std::size_t>(top - stack));
    task.storage->add_state(hash);
  }
  // In the past they hold nobody back.
  for (const SimTime until : no_processor_before_)
    hash.add(static_cast<std::uint64_t>(clock_.now() < until ? until.count() : 0));
}

}  // namespace ltsim
