// States that a search has come to, by their hashes, and what of each is left to be done: open addressing, no deletion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim_clock/explore/decision_path.hpp"

namespace ltsim {

class SeenStates {
 public:
  SeenStates() : slots_(1024) {}

  /// In the state, all tasks but those of `asleep` are about to be tried, if they can take a step.
  /// @return  those that were tried in it before; none if it is a new one
  TaskBits visit(std::uint64_t hash, TaskBits asleep) {
    if (2 * count_ >= slots_.size()) grow();
    if (hash == 0) hash = 1;  // 0 marks a free slot
    Slot& slot = find(slots_, hash);
    if (slot.hash == 0) {
      slot = {.hash = hash, .asleep = asleep};
      ++count_;
      return 0;
    }
    const TaskBits tried = ~slot.asleep;
    slot.asleep &= asleep;
    return tried;
  }

  [[nodiscard]] std::uint64_t size() const noexcept { return count_; }

 private:
  struct Slot {
    std::uint64_t hash = 0;
    TaskBits asleep = 0;  // each time that it was come to
  };

  static Slot& find(std::vector<Slot>& slots, std::uint64_t hash) noexcept {
    const std::size_t mask = slots.size() - 1;
    std::size_t slot = hash & mask;
    while (slots[slot].hash != 0 && slots[slot].hash != hash) slot = (slot + 1) & mask;
    return slots[slot];
  }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.hash != 0) find(slots_, slot.hash) = slot;
    }
  }

  std::vector<Slot> slots_;
  std::uint64_t count_ = 0;
};

}  // namespace ltsim
