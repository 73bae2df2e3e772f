// From one thread that must not wait to one that may: event records in order, bounded.
//
// One thread pushes (a cycle, or the port), one takes (the archive's writer). A push takes constant time, without
// lock, allocation or system call, whatever the other side does. When the ring is full the record is lost and
// counted; as soon as there is room again a record of kind records_lost goes in first, so that the gap shows in the
// place where it is. A ring that is closed is taken from no more: what is pushed then is lost, too.
//
// Invariants
//   I1  records are taken in the order in which they were pushed, each once.
//   I2  pushed = taken + still inside + lost, records_lost records left out of the count; of a closed ring
//       pushed = taken + lost.
//   I3  each record lost for want of room is counted by exactly one records_lost record, or still by gap().
//   I4  a place is written by one side only between the moments at which the other gives it up and gets it back:
//       no data race.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
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

  /// The taking thread, after its last take(). The pushing side does not notice.
  void close() noexcept;
  /// The taking thread: the records_lost record that stands for what no other one tells of, as of the latest loss.
  [[nodiscard]] std::optional<EventRecord> gap() const noexcept;
  /// Any thread. All records lost so far.
  [[nodiscard]] std::uint64_t lost_count() const noexcept;
  [[nodiscard]] std::size_t capacity() const noexcept { return mask_ + 1; }

 private:
  void put(std::uint64_t position, const EventRecord& record) noexcept;
  void lose(std::uint64_t lost_before, const EventRecord& record) noexcept;

  static constexpr std::size_t cache_line = 64;

  const std::size_t mask_;
  const std::unique_ptr<EventRecord[]> places_;

  // Each side writes a line of its own. Positions only grow; 64 bits do not wrap.
  alignas(cache_line) std::atomic<std::uint64_t> pushed_{0};
  std::atomic<std::uint64_t> offered_{0};  ///< calls of push
  std::atomic<std::uint64_t> lost_{0};     ///< for want of room
  std::uint64_t lost_reported_ = 0;
  std::uint64_t taken_seen_ = 0;  ///< `taken_` when the pushing side last looked
  // Of the record lost last; written only then.
  std::atomic<std::int64_t> lost_time_ns_{0};
  std::atomic<std::uint64_t> lost_scan_number_{0};
  std::atomic<std::uint8_t> lost_cycle_{0};
  alignas(cache_line) std::atomic<std::uint64_t> taken_{0};
  std::atomic<std::uint64_t> records_taken_{0};  ///< without records_lost records
  std::atomic<bool> closed_{false};
  std::uint64_t lost_taken_ = 0;  ///< told by records_lost records that were taken
};

}  // namespace emulator_models::soft_plc
