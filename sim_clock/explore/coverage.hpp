// What an exploration has seen so far, for strategies that learn where something new is to be found: who reads
// what whom has written, and the abstract states that a scenario tells.
//
// Things seen are bits of one table, by hash: two of them may share a bit, and the second then counts as
// seen. Read new_in_execution() right after an execution, before the same choices are run again: a second time
// nothing is new (ExecutionSummary::new_states). The table is shared with forked processes. The hashes hold places
// in the code and numbers of tasks and segments, no addresses: the count is the same in every process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sim_clock/check/race_detector.hpp"
#include "sim_clock/explore/memory_across_forks.hpp"

namespace ltsim {

class Coverage {
 public:
  Coverage() = default;

  /// Begins a new exploration: nothing was seen yet.
  void forget();
  void begin_execution() noexcept { new_count_ = 0; }
  /// Things that this execution was the first to show.
  [[nodiscard]] std::uint64_t new_in_execution() const noexcept { return new_count_; }

  /// What is seen is marked in these bytes, too, by hash: a fuzzing engine looks there for what an input shows, and sets them
  /// to zero before the next one. None at first.
  /// @param marks  a power of two of them; they outlive this
  void mark_in(std::span<std::uint8_t> marks) noexcept { marks_ = marks; }
  [[nodiscard]] bool marks() const noexcept { return !marks_.empty(); }

  void reads_from(RaceDetector::LastWrite writer, const SharedAccess& reader) noexcept {
    const std::uint64_t wrote = std::uint64_t{writer.task} << 32U | writer.site;
    const std::uint64_t read = std::uint64_t{reader.task} << 32U | reader.site;
    const std::uint64_t where = reader.place / 8;
    see((wrote * 0x9e3779b97f4a7c15U) ^ ((read ^ where << 44U) * 0xd1b54a32d192ed03U));
  }

  void abstract_state(std::uint64_t hash) noexcept { see(hash * 0xbf58476d1ce4e5b9U + 1); }

 private:
  static constexpr unsigned table_bits = 20;  // 128 KiB

  void see(std::uint64_t hash) noexcept {
    const std::uint64_t bit = ((hash ^ hash >> 32U) * 0x94d049bb133111ebU) >> (64 - table_bits);
    if (!marks_.empty()) marks_[bit & (marks_.size() - 1)] = 1;
    std::uint64_t& word = words()[bit / 64];
    const std::uint64_t mask = std::uint64_t{1} << (bit % 64);
    if ((word & mask) != 0) return;
    word |= mask;
    ++new_count_;
  }

  [[nodiscard]] std::uint64_t* words() const noexcept {
    return reinterpret_cast<std::uint64_t*>(seen_.bytes().data());
  }

  SharedMemory seen_{std::size_t{1} << (table_bits - 3)};  // 64 bits a word
  std::uint64_t new_count_ = 0;
  std::span<std::uint8_t> marks_;
};

}  // namespace ltsim
