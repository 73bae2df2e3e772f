#include "tests/kill_run/journal.hpp"

#include <new>

#include "protocol/check.hpp"

namespace kill_run {

Journal::Journal(std::size_t capacity)
    : capacity_(capacity), pages_(sizeof(Head) + capacity * sizeof(Entry)) {
  ::new (pages_.address()) Head{};
}

void Journal::append(const Entry& entry) noexcept {
  const std::size_t count = head().count.load(std::memory_order_relaxed);
  PLC_CHECK(count < capacity_);
  ::new (first() + count) Entry(entry);
  // Release: whoever sees the number sees the entry. A killed process has made its stores or not, in this order.
  head().count.store(count + 1, std::memory_order_release);
}

std::span<const Entry> Journal::entries() const noexcept {
  return {first(), head().count.load(std::memory_order_acquire)};
}

Journal::Head& Journal::head() const noexcept { return *static_cast<Head*>(pages_.address()); }

Entry* Journal::first() const noexcept { return reinterpret_cast<Entry*>(&head() + 1); }

}  // namespace kill_run
