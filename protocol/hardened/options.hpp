// How the hardened handoff is set up.
//
// Both sides must be told the same capacities and the same profile of doorbells. Rules and Orders are there to show that
// each of them is needed: a test takes one away and sees what follows. A program leaves them as they are.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace protocol::hardened {

/// Each rule holds. Taken away, it makes the mutant of that number (README.md).
struct Rules {
  bool answer_by_swap = true;       ///< M1: a response is published by a swap, not by a store
  bool withdraw_by_swap = true;     ///< M2: a request is withdrawn by a swap, not by a store
  bool phase_decides = true;        ///< M3: what a doorbell means is asked of the state word
  bool duplicate_store = true;      ///< M4: a request that comes again is answered from the store
  bool generation_advances = true;  ///< M5: at each attach
  bool doubt_is_kept = true;        ///< M6: a request given up in BUSY is not reported as not executed
  bool query_from_first_generation =
      true;                         ///< M7: the swap that publishes a query tests the generation itself
  bool empties_before_look = true;  ///< M8: a slave's attach empties its doorbell, then looks at the word
  bool take_before_read = true;     ///< M9: the request area is read after the request was taken
  bool sequence_advances = true;    ///< M9 with one sequence: each request has another number than the last
};

/// The memory orders that hand an area over. Each is needed: relaxed, it is a data race (README.md). All other accesses to
/// the state word are relaxed (state_cell.hpp).
struct Orders {
  /// The master's look at RESPONSE, IDLE or LOST, before it reads an area or fills one: the slave has done with it.
  std::memory_order look = std::memory_order_acquire;
  /// IDLE to REQUEST: the request area is filled before.
  std::memory_order publish = std::memory_order_release;
  /// REQUEST to BUSY: the slave reads what the publication has filled.
  std::memory_order take = std::memory_order_acquire;
  /// BUSY to RESPONSE: the response area is filled before.
  std::memory_order answer = std::memory_order_release;
  /// ORPHAN to IDLE: the slave has read the request before the master fills the area again.
  std::memory_order drop = std::memory_order_release;
  /// Any attach: what the predecessor did, which comes before by the lock of its role, comes before for the other side.
  std::memory_order attach = std::memory_order_release;
};

struct Options {
  enum class Doorbells : std::uint8_t {
    two,  ///< one each way
    one,  ///< to the slave only; the master polls
  };
  Doorbells doorbells = Doorbells::two;

  /// From the beginning of a call until its request is taken. Then it is withdrawn.
  std::chrono::nanoseconds take_timeout = std::chrono::milliseconds{100};
  /// From then on until it is answered. Then it is given up: its outcome is in doubt.
  std::chrono::nanoseconds answer_timeout = std::chrono::milliseconds{100};
  /// How often a call asks for the answer to a request that is in doubt, before it ends as unknown. Each query has both
  /// time-outs of its own.
  unsigned queries_max = 1;
  /// One doorbell: the master's pause between two looks at the state word.
  std::chrono::nanoseconds poll_interval = std::chrono::milliseconds{1};
  /// How long an opener waits for another process to finish making the named objects.
  std::chrono::nanoseconds open_timeout = std::chrono::seconds{1};

  /// Longest payloads. The areas are longer by a header.
  std::uint32_t request_bytes_max = 576;
  std::uint32_t response_bytes_max = 576;

  /// Sequence number of the first request of each session.
  std::uint64_t first_sequence = 1;

  Rules rules = {};
  Orders orders = {};
};

}  // namespace protocol::hardened
