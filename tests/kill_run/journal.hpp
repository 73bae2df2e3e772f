// What one side has done, entry by entry, in memory that outlives it.
//
// A step is journalled before it is taken where its absence is to prove something, and after it where its presence is:
// submitted, executing before; executed, ended, attached, closed after. An entry counts from the moment in which the
// number of entries says so, one store. So a process that is killed in the middle of an entry has not taken the step that
// the entry announces, or has taken the one that it reports: then its last entry is missing, which the accounts allow to
// killed processes only.
//
// One writer at a time: the next process of a side starts when the one before it is dead.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tests/kill_run/shared_pages.hpp"

namespace kill_run {

using Clock = std::chrono::steady_clock;

enum class Event : std::uint8_t {
  attached,     ///< plays its role
  open_failed,  ///< detail: protocol::SharedMemoryError
  closed,       ///< in good order
  // The kernel only.
  submitted,  ///< is about to hand this request to the protocol; digest: of its bytes
  given_up,   ///< the protocol gives it up in BUSY
  withdrawn,  ///< the protocol withdraws it from REQUEST
  ended,      ///< detail: protocol::ExchangeOutcome; digest, answered: of the answer, if it is ok
  // The emulator only.
  executing,  ///< is about to execute this request: from here on it counts as executed; digest: of its bytes
  executed,
};

struct Entry {
  Clock::time_point time = {};
  std::uint64_t request = 0;  ///< its number, as its bytes have it
  std::uint64_t digest = 0;
  std::uint64_t answered = 0;     ///< the number in the answer
  std::uint32_t incarnation = 0;  ///< which process of this side, from 1
  std::uint32_t round = 0;        ///< of a fresh request: the recovery it is to show; otherwise 0
  Event event = Event::attached;
  std::uint8_t detail = 0;
};

class Journal {
 public:
  /// @param capacity  in entries
  explicit Journal(std::size_t capacity);

  /// Aborts when it is full.
  void append(const Entry& entry) noexcept;
  /// Those that count, oldest first.
  [[nodiscard]] std::span<const Entry> entries() const noexcept;

 private:
  struct alignas(alignof(Entry)) Head {
    std::atomic<std::size_t> count;
  };

  [[nodiscard]] Head& head() const noexcept;
  [[nodiscard]] Entry* first() const noexcept;

  std::size_t capacity_;
  SharedPages pages_;
};

}  // namespace kill_run
