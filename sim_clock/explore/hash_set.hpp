// A set of 64-bit hashes, for counting different traces: open addressing, one word an entry, no deletion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ltsim {

class HashSet {
 public:
  /// @param entries_max  inserting more has no effect
  explicit HashSet(std::size_t entries_max) : entries_max_(entries_max), slots_(1024, 0) {}

  /// The hash is placed at the next call: until then the memory of its slot is on its way.
  void insert(std::uint64_t hash) {
    place_pending();
    pending_ = hash == 0 ? 1 : hash;  // 0 marks a free slot, and nothing pending
    __builtin_prefetch(&slots_[pending_ & (slots_.size() - 1)], 1);
  }

  [[nodiscard]] std::size_t size() {
    place_pending();
    return count_;
  }

 private:
  void place_pending() {
    if (pending_ == 0 || count_ == entries_max_) return;
    if (2 * count_ >= slots_.size()) grow();
    count_ += place(pending_) ? 1 : 0;
    pending_ = 0;
  }

  bool place(std::uint64_t hash) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash & mask;
    for (; slots_[slot] != 0; slot = (slot + 1) & mask) {
      if (slots_[slot] == hash) return false;
    }
    slots_[slot] = hash;
    return true;
  }

  void grow() {
    std::vector<std::uint64_t> old(2 * slots_.size(), 0);
    old.swap(slots_);
    for (const std::uint64_t hash : old) {
      if (hash != 0) place(hash);
    }
  }

  std::size_t entries_max_;
  std::size_t count_ = 0;
  std::uint64_t pending_ = 0;
  std::vector<std::uint64_t> slots_;  // a power of two of them, at most half full
};

}  // namespace ltsim
