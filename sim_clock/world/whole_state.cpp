#include "sim_clock/world/whole_state.hpp"

#include <algorithm>
#include <cerrno>
#include <span>

#include "sim_clock/world/watched_accesses.hpp"
#include "sim_clock/world/wipe_stack.hpp"
#include "sim_clock/world/world.hpp"

// Set by the linker: the begin of the program's initialised variables, and the end of all its variables.
extern "C" char __data_start;
extern "C" char _end;

namespace ltsim {
namespace {

std::span<const std::byte> variables() noexcept {
  return {reinterpret_cast<const std::byte*>(&__data_start), static_cast<std::size_t>(&_end - &__data_start)};
}

std::uintptr_t number_of(const void* address) noexcept { return reinterpret_cast<std::uintptr_t>(address); }

/// Most of them never change.
constexpr std::size_t page_bytes = 4096;
constexpr std::size_t line_bytes = 64;

/// More than a scenario uses outside of its tasks.
constexpr std::size_t stack_bytes = 32768;

}  // namespace

void WholeState::run(const std::function<void(World&)>& scenario) {
  wipe_stack<stack_bytes>();
  // What callers keep in registers is none of the scenario's, and it would save them on its stack. The frame pointer is this
  // function's own.
  static_cast<void>(__builtin_frame_address(0));
  asm volatile(
      "xorl %%ebx, %%ebx\n\t"
      "xorl %%r12d, %%r12d\n\t"
      "xorl %%r13d, %%r13d\n\t"
      "xorl %%r14d, %%r14d\n\t"
      "xorl %%r15d, %%r15d"
      :
      :
      : "rbx", "r12", "r13", "r14", "r15", "cc");
  run_from_here(scenario);
}

void WholeState::run_from_here(const std::function<void(World&)>& scenario) {
  stack_end_ = number_of(__builtin_frame_address(0));
  const auto all = variables();
  if (variables_at_first_.empty()) variables_at_first_.assign(all.begin(), all.end());
  active_ = this;
  watch_all_writes(true);
  Heap::begin(world_.scheduler().running());
  scenario(world_);
}

void WholeState::end() noexcept {
  if (active_ != this) return;
  Heap::end();
  watch_all_writes(false);
  active_ = nullptr;
}

std::uint64_t WholeState::hash() {
  if (Heap::overflowed())
    world_.unsupported("states are to be told apart, and the heap has too many blocks for that");
  const auto all = Heap::blocks();
  reached_.is_reached.assign(all.size(), false);
  reached_.to_look_at.clear();
  StateHash hash{world_.execution_number(), &reached_};
  // Where they lie does not matter, nor which lies before which.
  std::uint64_t blocks = 0;
  const auto add_block = [&](const Heap::Block& block) {
    StateHash of_block{world_.execution_number(), &reached_};
    of_block.add(block.name);
    of_block.add(block.bytes);
    of_block.add_memory(reinterpret_cast<const void*>(block.begin), block.bytes);
    blocks += of_block.value();
  };
  // What killed tasks have left only counts if somebody can still come to it.
  for (const Heap::Block& block : all) {
    if (!block.is_freed && !was_of_killed(block)) add_block(block);
  }
  world_.add_state(hash);
  const Scheduler& scheduler = world_.scheduler();
  const auto* const scenario_stack = static_cast<const std::byte*>(scheduler.main_stack_pointer());
  hash.add_memory(scenario_stack, stack_end_ - number_of(scenario_stack));
  add_variables(hash);
  while (!reached_.to_look_at.empty()) {
    const Heap::Block& block = all[reached_.to_look_at.back()];
    reached_.to_look_at.pop_back();
    if (was_of_killed(block)) add_block(block);
  }
  hash.add(blocks);
  return hash.value();
}

bool WholeState::was_of_killed(const Heap::Block& block) const noexcept {
  const Scheduler& scheduler = world_.scheduler();
  const std::size_t owner = block.allocated_by();
  return owner < scheduler.tasks_count() &&
         scheduler.task(static_cast<TaskId>(owner)).state == Task::State::killed;
}

void WholeState::add_variables(StateHash& hash) const noexcept {
  const auto now = variables();
  const std::uintptr_t world = number_of(&world_);
  for (std::size_t page = 0; page < now.size(); page += page_bytes) {
    const std::size_t bytes = std::min(page_bytes, now.size() - page);
    if (std::memcmp(&now[page], &variables_at_first_[page], bytes) == 0) continue;
    for (std::size_t at = page; at < page + bytes; at += line_bytes) {
      const std::size_t length = std::min(line_bytes, page + bytes - at);
      // The simulator's own: what of it is state went in already.
      if (number_of(&now[at]) + length > world && number_of(&now[at]) < world + sizeof(World)) continue;
      if (std::memcmp(&now[at], &variables_at_first_[at], length) == 0) continue;
      hash.add(at);
      hash.add_memory(&now[at], length);
    }
  }
}

void WholeState::written_elsewhere(std::uintptr_t address) noexcept {
  check_write(address);
  wipe_stack<stack_bytes_of_ours>();
}

void WholeState::check_write(std::uintptr_t address) noexcept {
  const Scheduler& scheduler = world_.scheduler();
  // What is written before and after the tasks run is the same in each execution, or is looked at by nobody who is in it.
  if (scheduler.running() == nullptr) return;
  const auto all = variables();
  if (address - number_of(all.data()) < all.size()) return;
  const Heap::Block* const block = Heap::find(address);
  if (block != nullptr && !block->is_freed) return;
  if (Segments::contains(reinterpret_cast<const void*>(address))) return;
  if (address >= number_of(scheduler.main_stack_pointer()) && address < stack_end_) return;
  for (std::size_t i = 0; i < scheduler.tasks_count(); ++i) {
    const Task& task = scheduler.task(static_cast<TaskId>(i));
    if (task.storage->contains(address) || address - number_of(&task.body) < sizeof task.body) return;
  }
  world_.unsupported(
      "states are to be told apart, and the scenario or the code under test has written to memory that does "
      "not belong to the execution: it was allocated before, or belongs to whoever runs the scenario");
}

}  // namespace ltsim
