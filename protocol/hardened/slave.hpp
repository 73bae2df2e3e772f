// The emulator's side of the hardened handoff.
//
//   1  wait for the doorbell, look: anything but REQUEST: back to the wait
//   2  REQUEST -> BUSY by a swap; only now the request area is touched
//   3  copy the request, check the copy: defective, or for another slave: answered so, not executed
//   4  executed last: answered from the duplicate store. Otherwise executed by the caller, and stored
//   5  fill the response area, BUSY -> RESPONSE, ring; if the master has given up, ORPHAN -> IDLE, ring
//
// Invariants
//   I3   what is executed is a request as it was submitted: whole, checked in the copy.
//   I5   no request is executed twice by one slave; a new slave finds none that an earlier one may have executed.
//   I11  doorbells mean nothing: more of them than requests lead to nothing.
// One thread opens and closes, and lives as long as the slave is open; one thread, the same or another, serves.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "protocol/exchange_sides.hpp"
#include "protocol/hardened/duplicate_store.hpp"
#include "protocol/hardened/endpoint.hpp"
#include "protocol/hardened/message.hpp"

namespace protocol::hardened {

class Slave final : public Endpoint, public ExchangeSlave {
 public:
  /// @param observer  told of each event of the exchange; must outlive the slave; nullptr = nobody listens
  Slave(std::string segment_name, const Options& options, ExchangeObserver* observer = nullptr);
  ~Slave() override;

  /// Takes the role of the slave and begins to serve. A request that nobody has taken is dropped, one that was taken
  /// is lost.
  /// @return cannot_open, role_taken, not_made_in_time, other_layout, other_segment
  [[nodiscard]] tl::expected<void, SharedMemoryError> open() noexcept override;
  /// Stops in good order: a request that nobody has taken is dropped. Gives the role back.
  void close() noexcept override;
  [[nodiscard]] bool is_open() const noexcept;

  /// Steps 1 to 4.
  [[nodiscard]] bool wait_for_request() noexcept override;
  [[nodiscard]] std::span<const std::byte> read_request() noexcept override;
  /// Steps 4 and 5.
  /// @param response  one that is longer than response_bytes_max cannot be answered: the master's outcome is unknown
  void write_response(std::span<const std::byte> response) noexcept override;
  void request_stop() noexcept override;

 private:
  /// Steps 3 and 4, with a request that was taken.
  /// @return whether it is to be executed; otherwise it was answered
  bool read_taken_request() noexcept;
  void answer(Status status, std::span<const std::byte> payload) noexcept;
  /// Step 5.
  void hand_over(std::span<const std::byte> message) noexcept;
  void ring_master() noexcept;

  std::uint64_t number_ = 0;  // of this slave
  std::vector<std::byte> request_message_;
  std::vector<std::byte> response_message_;
  std::optional<std::span<const std::byte>> read_;  // what was found in the request area
  Request request_;
  StateWord taken_;
  DuplicateStore store_;
  std::atomic<bool> stop_requested_ = false;
  bool stop_ring_taken_ = false;
};

static_assert(std::atomic<bool>::is_always_lock_free, "request_stop() may run in a signal handler");

}  // namespace protocol::hardened
