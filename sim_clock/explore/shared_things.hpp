// The things that operations act on, told apart as far as strategies need it, and which of them several tasks
// use. Learned from execution to execution.
//
// A thing is a semaphore, a mutex, four bytes of a segment; all atomics outside of segments are one thing. Calls
// that make and find things by name are none: they fill the begin of an execution, and the strategies reach
// them in those executions in which they draw from everything.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "sim_clock/clock/virtual_clock.hpp"
#include "sim_clock/world/operation.hpp"

namespace ltsim {

class SharedThings {
 public:
  /// Those beyond count as the last.
  static constexpr std::size_t things_max = 64;
  /// What acts on no thing that others could act on too.
  static constexpr std::size_t none = things_max;

  /// An execution begins: what was seen since the last learn() is forgotten.
  void begin() noexcept;
  void learn() noexcept;

  /// @return 0 to count() - 1, or none: also memory of a whole program that was not contended for so far
  [[nodiscard]] std::size_t thing_of(const Operation& operation) noexcept;
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

  /// `task` uses the thing. Known from the next learn() on: an execution that is run again knows no more than
  /// at its first run.
  void use(std::size_t thing, TaskId task, bool is_contended) noexcept {
    if (is_contended) users_[thing] = several;
    if (users_[thing] == nobody) users_[thing] = task;
    if (users_[thing] != task) users_[thing] = several;
  }
  /// Whether several tasks used it in the executions that were learned from.
  [[nodiscard]] bool is_shared(std::size_t thing) const noexcept { return learned_users_[thing] == several; }

 private:
  static constexpr TaskId nobody = VirtualClock::no_task;
  static constexpr TaskId several = nobody - 1;
  static constexpr std::size_t slots_count = 4 * things_max;

  std::array<std::uint64_t, things_max> keys_{};
  std::array<TaskId, things_max> users_{};
  std::array<TaskId, things_max> learned_users_{};
  std::array<std::uint8_t, slots_count> slots_{};  // a hash table: number of the thing plus one; 0: free
  std::size_t count_ = 0;
  std::size_t learned_count_ = 0;
};

}  // namespace ltsim
