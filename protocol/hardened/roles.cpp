#include "protocol/hardened/roles.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <utility>

#include "protocol/check.hpp"

namespace protocol::hardened {

namespace {

/// More than processes are ever killed in the instant in which a new object gets its locks.
constexpr std::size_t sets_max = 16;

}  // namespace

struct Roles::Layout {
  std::atomic<std::uint32_t> published;
  std::atomic<std::uint32_t> claimed;
  std::atomic<MemoryIdentity> segment;
  std::array<Locks, sets_max> sets;
};

tl::expected<void, SharedMemoryError> Roles::take(Side side,
                                                  std::chrono::steady_clock::time_point deadline) noexcept {
  PLC_CHECK(!holds_role_);
  side_ = side;
  for (;;) {
    if (!open()) return tl::unexpected(SharedMemoryError::cannot_open);
    holds_role_ = lock_of(side).try_lock();
    if (!holds_role_) {
      give_back();
      return tl::unexpected(SharedMemoryError::role_taken);
    }
    holds_making_ = locks_->making.lock_until(deadline);
    if (!holds_making_) {
      give_back();
      return tl::unexpected(SharedMemoryError::not_made_in_time);
    }
    // It may have been removed, and even made again, between opening and locking it.
    if (NamedMemory::identity_of(name_) == memory_.identity) return {};
    give_back();
  }
}

void Roles::made() noexcept {
  if (std::exchange(holds_making_, false)) locks_->making.unlock();
}

bool Roles::try_take_other() noexcept {
  const Side other = side_ == Side::master ? Side::slave : Side::master;
  holds_other_ = holds_other_ || lock_of(other).try_lock();
  return holds_other_;
}

void Roles::give_back_other() noexcept {
  const Side other = side_ == Side::master ? Side::slave : Side::master;
  if (std::exchange(holds_other_, false)) lock_of(other).unlock();
}

void Roles::give_back() noexcept {
  made();
  give_back_other();
  if (std::exchange(holds_role_, false)) lock_of(side_).unlock();
  locks_ = nullptr;
  memory_.close();
}

// The lock for making orders these.
MemoryIdentity Roles::segment() const noexcept { return layout().segment.load(std::memory_order_relaxed); }

void Roles::set_segment(MemoryIdentity segment) noexcept {
  layout().segment.store(segment, std::memory_order_relaxed);
}

bool Roles::open() noexcept {
  if (memory_.open(name_, sizeof(Layout))) return false;
  locks_ = find_or_make_locks();
  if (locks_ == nullptr) memory_.close();
  return locks_ != nullptr;
}

Roles::Locks* Roles::find_or_make_locks() noexcept {
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free &&
                std::atomic<MemoryIdentity>::is_always_lock_free);
  Layout& found = layout();
  // Acquire, and release below: the locks of the set are made before it is published.
  std::uint32_t published = found.published.load(std::memory_order_acquire);
  if (published == 0) {
    const std::uint32_t index = found.claimed.fetch_add(1, std::memory_order_relaxed);
    if (index >= sets_max) return nullptr;
    Locks& own = found.sets[index];
    if (!own.making.init() || !own.master.init() || !own.slave.init()) return nullptr;
    if (found.published.compare_exchange_strong(published, index + 1, std::memory_order_release,
                                                std::memory_order_acquire)) {
      published = index + 1;
    }
  }
  return published <= sets_max ? &found.sets[published - 1] : nullptr;
}

Roles::Layout& Roles::layout() const noexcept { return *static_cast<Layout*>(memory_.region.get_address()); }

}  // namespace protocol::hardened
