// A set of tasks as the scheduler hands it out: one bit a task, 64 to a word.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "sim_clock/clock/virtual_clock.hpp"

namespace ltsim {

/// @param set  may be shorter than the task's number: it is not in it then
[[nodiscard]] inline bool contains(std::span<const std::uint64_t> set, std::size_t task) noexcept {
  return task / 64 < set.size() && (set[task / 64] >> (task % 64) & 1U) != 0;
}

template <typename Function>
void for_each_task(std::span<const std::uint64_t> set, Function&& function) {
  for (std::size_t word = 0; word < set.size(); ++word) {
    for (std::uint64_t bits = set[word]; bits != 0; bits &= bits - 1) {
      function(static_cast<TaskId>(word * 64 + static_cast<std::size_t>(std::countr_zero(bits))));
    }
  }
}

}  // namespace ltsim
