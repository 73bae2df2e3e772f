// The whole state of an execution as one number: two executions that are in equal states have the same futures.
//
// What goes in: the stacks, registers and thread-locals of the tasks; what they wait for, and how long; the scenario's own stack;
// the heap blocks that were made since the execution began; the variables of the program; segments, semaphores, mutexes,
// descriptors; the clock; faults that are still granted. What checks of a scenario keep is memory like any other.
//
// Memory that is none of these and that the code under test writes to would be missing: the execution ends as unsupported. Not for weak
// memory, whose histories do not go in, nor for one processor (Prover refuses both).
//
// What does not go in: how many steps were taken, which decides nothing; what the race detector remembers, so a race that shows only
// on one of two ways into the same state may go unseen; and which address the heap, or which number the next descriptor, will have, so
// code that compares those of what is gone with those of what came in its place may go unseen.
//
// Words that the code does not need any more make two states of one, never one of two. There are few: neither the simulator's own
// frames go in (kept_registers.hpp), nor where a killed process stood and when it was started again, nor what it has left on the heap and
// nobody can come to; stacks are cleaned below.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "sim_clock/world/state_hash.hpp"

namespace ltsim {

class World;

class WholeState {
 public:
  explicit WholeState(World& world) noexcept : world_(world) {}
  ~WholeState() { end(); }
  WholeState(const WholeState&) = delete;
  WholeState& operator=(const WholeState&) = delete;

  /// Runs the scenario so that hash() can be called.
  void run(const std::function<void(World&)>& scenario);
  /// The execution is over. Without run() it does nothing.
  void end() noexcept;

  /// While every task stands still: Strategy::looks_at_states().
  [[nodiscard]] std::uint64_t hash();

  /// Code under test, or a check of the scenario, is about to write there. Or the search itself, which is paused then (Heap::Pause),
  /// by a function that it and instrumented code have in common.
  static void written(const volatile void* address) noexcept {
    if (active_ != nullptr && Heap::is_on())
      active_->written_elsewhere(reinterpret_cast<std::uintptr_t>(address));
  }

 private:
  [[gnu::noinline]] void run_from_here(const std::function<void(World&)>& scenario);
  void written_elsewhere(std::uintptr_t address) noexcept;
  void check_write(std::uintptr_t address) noexcept;
  void add_variables(StateHash& hash) const noexcept;
  [[nodiscard]] bool was_of_killed(const Heap::Block& block) const noexcept;

  static inline WholeState* active_ = nullptr;

  World& world_;
  std::uintptr_t stack_end_ = 0;  // what lies on the stack from there on is none of the scenario's
  std::vector<std::byte> variables_at_first_;
  StateHash::Reached reached_;
};

}  // namespace ltsim
