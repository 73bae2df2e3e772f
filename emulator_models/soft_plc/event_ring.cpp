#include "emulator_models/soft_plc/event_ring.hpp"

#include <algorithm>
#include <bit>

namespace emulator_models::soft_plc {

EventRing::EventRing(std::size_t capacity)
    : mask_{std::bit_ceil(std::clamp(capacity, capacity_min, capacity_max)) - 1},
      places_{std::make_unique<EventRecord[]>(mask_ + 1)} {}

void EventRing::put(std::uint64_t position, const EventRecord& record) noexcept {
  places_[static_cast<std::size_t>(position) & mask_] = record;
}

void EventRing::lose(std::uint64_t lost_before, const EventRecord& record) noexcept {
  // relaxed: a record of its own, for a reader to whom a mixture of two losses is as good
  lost_time_ns_.store(record.time_ns, std::memory_order_relaxed);
  lost_scan_number_.store(record.scan_number, std::memory_order_relaxed);
  lost_cycle_.store(record.cycle, std::memory_order_relaxed);
  lost_.store(lost_before + 1, std::memory_order_relaxed);  // a count, nothing hangs on it
}

bool EventRing::push(const EventRecord& record) noexcept {
  const std::uint64_t position = pushed_.load(std::memory_order_relaxed);  // only this side writes it
  const std::uint64_t lost = lost_.load(std::memory_order_relaxed);        // as above
  // relaxed: a count that only this side writes; nothing hangs on it
  offered_.store(offered_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  const bool gap = lost != lost_reported_;
  const std::size_t needed = gap ? 2 : 1;
  if (position + needed - taken_seen_ > capacity()) {
    // acquire: the places were read by the other side before it gave them up
    taken_seen_ = taken_.load(std::memory_order_acquire);
    if (position + needed - taken_seen_ > capacity()) {
      lose(lost, record);
      return false;
    }
  }
  if (gap) {
    put(position, {.kind = EventKind::records_lost,
                   .cycle = record.cycle,
                   .time_ns = record.time_ns,
                   .scan_number = record.scan_number,
                   .values = {static_cast<std::int64_t>(lost - lost_reported_)}});
    lost_reported_ = lost;
  }
  put(position + needed - 1, record);
  // release: whoever sees the new position sees what was put
  pushed_.store(position + needed, std::memory_order_release);
  return true;
}

std::size_t EventRing::take(std::span<EventRecord> into) noexcept {
  const std::uint64_t position = taken_.load(std::memory_order_relaxed);  // only this side writes it
  // acquire: pairs with the release in push
  const std::uint64_t ready = pushed_.load(std::memory_order_acquire) - position;
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(ready, into.size()));
  std::size_t gaps = 0;
  for (std::size_t i = 0; i < count; ++i) {
    into[i] = places_[static_cast<std::size_t>(position + i) & mask_];
    if (into[i].kind != EventKind::records_lost) continue;
    ++gaps;
    lost_taken_ += static_cast<std::uint64_t>(into[i].values[0]);
  }
  // relaxed: a count that only this side writes; nothing hangs on it
  records_taken_.store(records_taken_.load(std::memory_order_relaxed) + count - gaps,
                       std::memory_order_relaxed);
  // release: our reads of the places are over before the other side can write them again
  taken_.store(position + count, std::memory_order_release);
  return count;
}

void EventRing::close() noexcept {
  // release: who sees the ring closed sees all that was taken from it
  closed_.store(true, std::memory_order_release);
}

std::optional<EventRecord> EventRing::gap() const noexcept {
  // relaxed: of a push under way either state is good
  const std::uint64_t lost = lost_.load(std::memory_order_relaxed) - lost_taken_;
  if (lost == 0) return std::nullopt;
  return EventRecord{.kind = EventKind::records_lost,
                     .cycle = lost_cycle_.load(std::memory_order_relaxed),
                     .time_ns = lost_time_ns_.load(std::memory_order_relaxed),
                     .scan_number = lost_scan_number_.load(std::memory_order_relaxed),
                     .values = {static_cast<std::int64_t>(lost)}};
}

std::uint64_t EventRing::lost_count() const noexcept {
  // acquire: pairs with close()
  if (closed_.load(std::memory_order_acquire))
    return offered_.load(std::memory_order_relaxed) - records_taken_.load(std::memory_order_relaxed);
  return lost_.load(std::memory_order_relaxed);
}

}  // namespace emulator_models::soft_plc
