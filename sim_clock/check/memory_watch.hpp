// Notices shared memory that changed without an access that the world saw: written by inline assembly, by a
// library that was not instrumented, by the kernel. Where that happens scheduling points are missing, and an
// execution that passes means nothing.
//
// A second copy of all segments holds what memory should hold. Before each access the eight bytes around it
// are compared, at the end of an execution everything. A write is announced before it is made, by a task that
// goes on at once: what it wrote is taken into the copy when anybody accesses anything next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "sim_clock/check/race_detector.hpp"

namespace ltsim {

class MemoryWatch {
 public:
  /// @param memory  all segments, one after the other, by SharedPlace; outlives this
  explicit MemoryWatch(const std::byte* memory);
  ~MemoryWatch();
  MemoryWatch(const MemoryWatch&) = delete;
  MemoryWatch& operator=(const MemoryWatch&) = delete;
  void reset() noexcept { pending_bytes_ = 0; }

  /// A task is about to access bytes that the world sees.
  /// @return whether memory is there as it should be
  [[nodiscard]] bool access(SharedPlace place, std::size_t bytes, bool writes) noexcept {
    settle();
    bool as_it_should_be = true;
    for (std::size_t i = place / 8; i <= (place + bytes - 1) / 8; ++i)
      as_it_should_be = as_it_should_be && memory_[i] == expected_[i];
    if (writes) announce(place, bytes);
    return as_it_should_be;
  }

  /// The running task is about to change these bytes, before anybody accesses anything else.
  void announce(SharedPlace place, std::size_t bytes) noexcept {
    pending_place_ = place;
    pending_bytes_ = bytes;
  }

  /// The bytes were changed on purpose just now, by the world itself.
  void accept(SharedPlace place, std::size_t bytes) noexcept;

  /// The same where they have become zero.
  void zero(SharedPlace place, std::size_t bytes) noexcept;

  /// @return the first byte of the range that is not as it should be
  [[nodiscard]] std::optional<SharedPlace> find_change(SharedPlace place, std::size_t bytes) noexcept;

 private:
  /// Takes over what the last announced write has written.
  void settle() noexcept {
    if (pending_bytes_ == 0) return;
    const std::size_t begin = pending_place_;
    const std::size_t end = begin + pending_bytes_;
    pending_bytes_ = 0;
    for (std::size_t i = begin / 8; i * 8 < end; ++i) {
      std::uint64_t mask = ~std::uint64_t{0};  // of the bytes to take over, in the order of memory
      if (begin > i * 8) mask <<= 8 * (begin - i * 8);
      if (end < i * 8 + 8) mask &= ~std::uint64_t{0} >> 8 * (i * 8 + 8 - end);
      expected_[i] = (expected_[i] & ~mask) | (memory_[i] & mask);
    }
  }

  const std::uint64_t* memory_;
  std::uint64_t* expected_;
  SharedPlace pending_place_ = 0;
  std::size_t pending_bytes_ = 0;
};

}  // namespace ltsim
