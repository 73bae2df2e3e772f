// From one thread that must not wait to one that may: event records in order, bounded.
//
// One thread pushes (a cycle, or the port), one takes (the archive's writer). A push takes constant time, without
// lock, allocation or system call, whatever the other side does. When the ring is full the record is lost and
// counted; as soon as there is room again a record of kind records_lost goes in first, so that the gap shows in the
// place where it is.
//
// Invariants
//   I1  records are taken in the order in which they were pushed, each once.
//   I2  pushed = taken + still inside + lost, records_lost records left out of the count.
//   I3  each lost record is counted by exactly one records_lost record, or still by lost_unreported().
//   I4  a place is written by one side only between the moments at which the other gives it up and gets it back:
//       no data race.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "emulator_models/soft_plc/event_record.hpp"

namespace emulator_models::soft_plc {

class EventRing {
 public:
  static constexpr std::size_t capacity_min = 2;          ///< a gap's record and the one after it
  static constexpr std::size_t capacity_max = 1'048'576;  ///< 64 MiB

  /// @param capacity  records; taken up to the next power of two, and into the limits
  explicit EventRing(std::size_t capacity);

  /// The pushing thread.
  /// @return false = lost, and counted
  bool push(const EventRecord& record) noexcept;

  /// The taking thread: the oldest records.
  /// @return how many were written to the front of `into`
  std::size_t take(std::span<EventRecord> into) noexcept;

  /// Any thread. All records lost so far.
  [[nodiscard]] std::uint64_t lost_count() const noexcept { return lost_.load(std::memory_order_relaxed); }
  /// The taking thread, when nobody pushes any more: lost records that no records_lost record tells of.
  [[nodiscard]] std::uint64_t lost_unreported() const noexcept { return lost_count() - lost_taken_; }
  [[nodiscard]] std::size_t capacity() const noexcept { return mask_ + 1; }

 private:
  void put(std::uint64_t position, const EventRecord& record) noexcept;

  static constexpr std::size_t cache_line = 64;

  const std::size_t mask_;
  const std::unique_ptr<EventRecord[]> places_;

  // Each side writes a line of its own. Positions only grow; 64 bits do not wrap.
  alignas(cache_line) std::atomic<std::uint64_t> pushed_{0};
  std::atomic<std::uint64_t> lost_{0};
  std::uint64_t lost_reported_ = 0;
  std::uint64_t taken_seen_ = 0;  ///< `taken_` when the pushing side last looked
  alignas(cache_line) std::atomic<std::uint64_t> taken_{0};
  std::uint64_t lost_taken_ = 0;  ///< told by records_lost records that were taken
};

}  // namespace emulator_models::soft_plc
