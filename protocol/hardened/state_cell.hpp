// The state word in shared memory: one lock-free atomic, loaded whole and changed whole.
//
// The orders that hand an area over are in Orders, with their reasons. Relaxed is
//   a look that a swap follows: the swap finds out whether it still holds;
//   a swap that fails: nobody uses what it found, who wants to know looks again;
//   a withdrawal, a give-up, an acknowledgement, a stop: they hand over nothing that was written;
//   RESPONSE to IDLE: who fills the response area next has taken a later request, whose publication comes after this in
//   the same master; or in the next one, which comes after this one by the lock of the role.
// Nothing is sequentially consistent: no side ever leaves out a post because of what it
// has seen of the other, so no store need be seen before a later load (race O10).
#pragma once

#include <atomic>
#include <cstdint>

#include "protocol/hardened/state_word.hpp"

namespace protocol::hardened {

class StateCell {
 public:
  static_assert(std::atomic_ref<std::uint32_t>::is_always_lock_free, "a lock cannot span processes");

  /// @param word  4-aligned, in the segment
  explicit StateCell(std::uint32_t& word) noexcept : word_(word) {}

  [[nodiscard]] StateWord load(std::memory_order order) const noexcept {
    return decode(order == std::memory_order_relaxed ? word_.load(std::memory_order_relaxed)
                                                     : word_.load(std::memory_order_acquire));
  }

  /// One step: `next` in place of `expected`, if that is what is there.
  /// @param order  relaxed, acquire or release: of the swap that succeeds
  /// @return whether it was
  [[nodiscard]] bool swap(const StateWord& expected, const StateWord& next,
                          std::memory_order order) const noexcept {
    std::uint32_t found = encode(expected);
    // An order that is not a constant would be taken for the strongest.
    constexpr auto failure = std::memory_order_relaxed;
    switch (order) {
      case std::memory_order_relaxed:
        return word_.compare_exchange_strong(found, encode(next), std::memory_order_relaxed, failure);
      case std::memory_order_acquire:
        return word_.compare_exchange_strong(found, encode(next), std::memory_order_acquire, failure);
      default:
        return word_.compare_exchange_strong(found, encode(next), std::memory_order_release, failure);
    }
  }

  /// What no rule allows: mutants M1 to M3.
  void store(const StateWord& next) const noexcept { word_.store(encode(next), std::memory_order_release); }

 private:
  std::atomic_ref<std::uint32_t> word_;
};

}  // namespace protocol::hardened
