#include "protocol/hardened/doorbell.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "protocol/deadline.hpp"

namespace protocol::hardened {

namespace {

/// Far more than the few that requests, attaches and stops leave behind (I10). Half a minute would pass with SEM_VALUE_MAX.
constexpr unsigned emptied_rings_max = 1024;

}  // namespace

struct Doorbell::Layout {
  sem_t semaphore;
  std::atomic<std::uint32_t> is_made;
};

bool Doorbell::open(const std::string& name) noexcept {
  static_assert(offsetof(Layout, is_made) == 32, "both processes map this layout");
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "a lock cannot span processes");
  close();
  if (memory_.open(name, sizeof(Layout))) return false;
  Layout& found = layout();
  // Openers take turns, so nobody sees it half made; release, so that one who is killed here has not said so too early.
  if (found.is_made.load(std::memory_order_relaxed) == 0) {
    constexpr int between_processes = 1;
    if (::sem_init(&found.semaphore, between_processes, 0) != 0) {
      close();
      return false;
    }
    found.is_made.store(1, std::memory_order_release);
  }
  return true;
}

void Doorbell::ring() const noexcept { static_cast<void>(::sem_post(semaphore())); }

void Doorbell::wait() const noexcept { static_cast<void>(::sem_wait(semaphore())); }

void Doorbell::wait_until(std::chrono::steady_clock::time_point deadline) const noexcept {
  const timespec until = on_monotonic_clock(deadline);
  static_cast<void>(::sem_clockwait(semaphore(), CLOCK_MONOTONIC, &until));
}

bool Doorbell::try_take() const noexcept { return ::sem_trywait(semaphore()) == 0; }

void Doorbell::empty() const noexcept {
  for (unsigned taken = 0; taken < emptied_rings_max && try_take(); ++taken) {
  }
}

Doorbell::Layout& Doorbell::layout() const noexcept {
  return *static_cast<Layout*>(memory_.region.get_address());
}

sem_t* Doorbell::semaphore() const noexcept { return &layout().semaphore; }

}  // namespace protocol::hardened
