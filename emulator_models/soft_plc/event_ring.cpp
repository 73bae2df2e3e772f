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

bool EventRing::push(const EventRecord& record) noexcept {
  const std::uint64_t position = pushed_.load(std::memory_order_relaxed);  // only this side writes it
  const std::uint64_t lost = lost_.load(std::memory_order_relaxed);        // as above
  const bool gap = lost != lost_reported_;
  const std::size_t needed = gap ? 2 : 1;
  if (position + needed - taken_seen_ > capacity()) {
    // acquire: the places were read by the other side before it gave them up
    taken_seen_ = taken_.load(std::memory_order_acquire);
    if (position + needed - taken_seen_ > capacity()) {
      lost_.store(lost + 1, std::memory_order_relaxed);  // a count, nothing hangs on it
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
  for (std::size_t i = 0; i < count; ++i) {
    into[i] = places_[static_cast<std::size_t>(position + i) & mask_];
    if (into[i].kind == EventKind::records_lost) lost_taken_ += static_cast<std::uint64_t>(into[i].values[0]);
  }
  // release: our reads of the places are over before the other side can write them again
  taken_.store(position + count, std::memory_order_release);
  return count;
}

}  // namespace emulator_models::soft_plc
