// A hash of what an execution did, blind to the order of steps that have nothing to do with each other.
//
// Each step is hashed with the steps that it depends on: the one before it of its task, and the last ones on what
// it acts on. Time counts only through what it made tasks do. So two schedules that differ in where exactly a
// switch lies between two steps that matter have equal hashes, and a search need look at one of them first.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim_clock/clock/virtual_clock.hpp"
#include "sim_clock/world/operation.hpp"

namespace ltsim {

class CausalHash {
 public:
  CausalHash() : places_(places_max) {}

  void reset() noexcept;
  void add(TaskId task, const Operation& operation) noexcept;
  /// The last step of the task has taken a store that so many are newer than.
  void add_age(TaskId task, std::uint32_t age) noexcept;
  [[nodiscard]] std::uint64_t value() const noexcept { return sum_; }

 private:
  struct Place {
    std::uint64_t key = 0;
    std::uint64_t generation = 0;
    std::uint64_t change = 0;  // hash of the last step that changed it
    std::uint64_t looks = 0;   // sum over the steps that looked at it since
  };

  [[nodiscard]] Place& place(std::uint64_t key) noexcept;

  // Places beyond this many share entries: more orders are then told apart than need be.
  static constexpr std::size_t places_max = 1024;
  static constexpr std::size_t tasks_max = 256;

  std::vector<Place> places_;
  std::array<std::uint64_t, tasks_max> last_of_task_{};
  std::uint64_t generation_ = 0;
  std::uint64_t sum_ = 0;
};

}  // namespace ltsim
