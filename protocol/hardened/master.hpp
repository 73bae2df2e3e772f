// The kernel's side of the hardened handoff.
//
//   1  look: IDLE goes on; RAW, DOWN: nobody serves; LOST: acknowledged; otherwise wait, bounded
//   2  a query goes on only in the generation in which its request was published first
//   3  empty the doorbells, fill the request area
//   4  IDLE -> REQUEST by a swap from the very word that was looked at; ring
//   5  wait, look: RESPONSE: copy, check the copy, -> IDLE, deliver
//                  IDLE, DOWN: dropped untaken
//                  LOST: a slave died with it, -> IDLE
//                  REQUEST after take_timeout: -> IDLE, withdrawn
//                  BUSY after answer_timeout: -> ORPHAN, in doubt
//   6  in doubt: the same request again, as a query, at most queries_max times
//
// Each request ends in exactly one of
//   ok            its answer was delivered
//   rejected      the slave answered that it does not execute it
//   not_executed  the slave has not executed it and never will: it was withdrawn, dropped, or never published
//   unknown       it may have been executed: given up in BUSY, the slave died, or the answer was defective
// A request is never sent again but as a query, which a slave that has executed it answers without executing it.
//
// Invariants
//   I1   what is delivered answers this request: session and sequence are compared in the copy.
//   I6   not_executed is told only after a swap, or an attach of the other side, that no slave can come behind.
//   I15  a call ends within (take_timeout + answer_timeout) * (1 + queries_max) on the steady clock.
//   I16  no time-out before its full time.
// One thread at a time.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "protocol/exchange_sides.hpp"
#include "protocol/hardened/endpoint.hpp"

namespace protocol::hardened {

struct CallResult {
  ExchangeOutcome outcome = ExchangeOutcome::not_executed;
  std::size_t response_bytes = 0;  ///< ok: of the payload that was copied
  /// Not ok: rejected, not_executed, or why it is unknown: unanswered, slave_gone, damaged.
  SharedMemoryError why = SharedMemoryError::not_executed;

  bool operator==(const CallResult&) const = default;
};

class Master final : public Endpoint, public ExchangeMaster {
 public:
  /// @param observer  told of each event of the exchange; must outlive the master; nullptr = nobody listens
  Master(std::string segment_name, const Options& options, ExchangeObserver* observer = nullptr);
  ~Master() override;

  /// Takes the role of the master and begins a session.
  /// @return cannot_open, role_taken, not_made_in_time, other_layout, other_segment
  [[nodiscard]] tl::expected<void, SharedMemoryError> open() noexcept override;
  /// Gives up what is under way, at once, and gives the role back. An answer that is there ends it as ok, unread.
  void close() noexcept override;
  [[nodiscard]] bool is_open() const noexcept override;

  /// Steps 1 to 6.
  /// @param request  at most request_bytes_max, or it is not_executed
  /// @param into     what of the answer does not fit is lost
  CallResult call(std::span<const std::byte> request, std::span<std::byte> into) noexcept;

  /// Steps 1 to 4. A request that is under way is given up first, at once.
  /// @return request_too_long, no_slave, slave_is_busy: it is not executed
  [[nodiscard]] tl::expected<void, SharedMemoryError> write(
      std::span<const std::byte> request) noexcept override;
  /// Steps 5 and 6.
  /// @return CallResult::why; 0 bytes: the answer is empty, or nothing was written
  [[nodiscard]] tl::expected<std::size_t, SharedMemoryError> get_response(
      std::span<std::byte> into) noexcept override;
  /// How the last request ended; not_executed before the first.
  [[nodiscard]] ExchangeOutcome last_outcome() const noexcept { return last_outcome_; }

  void set_timeouts(std::chrono::nanoseconds take, std::chrono::nanoseconds read) noexcept override;
  [[nodiscard]] std::size_t response_bytes_max() const noexcept override;

 private:
  using Clock = std::chrono::steady_clock;

  /// A request that was written and has not ended.
  struct Exchange {
    StateWord published;        // as it was first
    Clock::time_point take_by;  // of this attempt
    Clock::time_point answer_by;
    bool is_query = false;
  };

  enum class Published : std::uint8_t { yes, no_slave, slave_is_busy, other_generation };
  /// How one attempt ended; what ends the request is an outcome.
  struct Attempt {
    bool in_doubt = false;  // given up in BUSY, by this attempt or an earlier one
    CallResult result;
  };

  /// Steps 1 to 4.
  Published publish(bool is_query) noexcept;
  /// Step 5.
  Attempt await(std::span<std::byte> into) noexcept;
  /// Steps 5 and 6.
  CallResult finish(std::span<std::byte> into) noexcept;
  /// The end of step 5: copies the answer, frees the areas.
  /// @param found  RESPONSE
  [[nodiscard]] CallResult accept(StateWord found, std::span<std::byte> into) noexcept;
  /// What a response that was read says of the request.
  [[nodiscard]] CallResult judge(const std::optional<std::span<const std::byte>>& message,
                                 const StateWord& word, std::span<std::byte> into) noexcept;
  void give_up_at_once() noexcept;
  void end(ExchangeOutcome outcome) noexcept;
  /// Until something may have changed, or the deadline.
  void wait(Clock::time_point now, Clock::time_point deadline) noexcept;
  [[nodiscard]] std::uint64_t expected_slave(std::uint16_t generation) const noexcept;

  std::chrono::nanoseconds take_timeout_;
  std::chrono::nanoseconds answer_timeout_;
  std::uint64_t session_ = 0;
  std::uint64_t sequence_ = 0;      // of the last request
  std::vector<std::byte> request_;  // the payload of the last request
  std::vector<std::byte> message_;  // to or from an area
  std::optional<Exchange> exchange_;
  ExchangeOutcome last_outcome_ = ExchangeOutcome::not_executed;
  /// Who answered last, and in which generation: there it is the one who serves.
  std::uint64_t known_slave_ = 0;
  std::uint16_t known_slave_generation_ = 0;
};

}  // namespace protocol::hardened
