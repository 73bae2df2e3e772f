// Virtual time of one World, and the timers that wake its tasks.
//
// Time stands still while code runs, except for a small fixed cost per scheduling point, and jumps when no
// task can run or when the strategy says that the machine was slow.
//
// Invariants
//   I1  now() never decreases.
//   I2  no timer is due before its deadline.
//   I3  timers with equal deadlines are due in the order in which they were armed.
// Not here: the wall clock (world/world.hpp adds a fixed epoch). No allocation after construction.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <limits>

namespace ltsim {

/// Nanoseconds since the world began.
using SimTime = std::chrono::nanoseconds;

/// Number of a task in its world: 0, 1, 2 ... in the order of creation.
using TaskId = std::uint16_t;

/// Most tasks one world can hold.
inline constexpr std::size_t tasks_max = 256;

class VirtualClock {
 public:
  static constexpr SimTime never = SimTime::max();

  /// Back to time 0, no timer armed.
  void reset() noexcept;

  [[nodiscard]] SimTime now() const noexcept { return now_; }

  /// Lets `duration` (>= 0) pass. Timers that fall due stay armed until take_due() returns them.
  void pass(SimTime duration) noexcept { now_ += duration; }

  /// Arms the one timer of `sleeper`; arming it again replaces the deadline.
  /// @param deadline  absolute; one in the past is due at once
  void arm(SimTime deadline, TaskId sleeper) noexcept;
  /// Disarms the timer of `sleeper`; one that is not armed is left alone.
  void cancel(TaskId sleeper) noexcept;

  /// Since reset().
  [[nodiscard]] bool any_armed_ever() const noexcept { return armed_ever_ != 0; }
  [[nodiscard]] bool any_armed() const noexcept { return armed_count_ != 0; }
  /// Earliest deadline; `never` when no timer is armed.
  [[nodiscard]] SimTime next_deadline() const noexcept {
    return armed_count_ == 0 ? never : heap_[0].deadline;
  }

  /// Of the timer of `sleeper`; `never` when it is not armed.
  [[nodiscard]] SimTime deadline_of(TaskId sleeper) const noexcept {
    return slot_of_[sleeper] == not_armed ? never : heap_[slot_of_[sleeper]].deadline;
  }

  /// Disarms and returns the earliest timer whose deadline is not after now().
  /// @return the sleeper; or no_task when nothing is due
  [[nodiscard]] TaskId take_due() noexcept;

  static constexpr TaskId no_task = std::numeric_limits<TaskId>::max();

 private:
  struct Timer {
    SimTime deadline;
    std::uint64_t order;
    TaskId sleeper;
    [[nodiscard]] bool before(const Timer& other) const noexcept {
      return deadline != other.deadline ? deadline < other.deadline : order < other.order;
    }
  };

  void place(std::size_t slot, const Timer& timer) noexcept;
  void rise(std::size_t slot, const Timer& timer) noexcept;
  void sink(std::size_t slot, const Timer& timer) noexcept;
  void remove(std::size_t slot) noexcept;

  static constexpr std::uint16_t not_armed = std::numeric_limits<std::uint16_t>::max();

  SimTime now_{0};
  std::uint64_t armed_ever_ = 0;
  std::size_t armed_count_ = 0;
  std::array<Timer, tasks_max> heap_{};                            // a binary heap, earliest first
  std::array<std::uint16_t, tasks_max> slot_of_ = make_unarmed();  // by sleeper

  static constexpr std::array<std::uint16_t, tasks_max> make_unarmed() noexcept {
    std::array<std::uint16_t, tasks_max> slots{};
    slots.fill(not_armed);
    return slots;
  }
};

}  // namespace ltsim
