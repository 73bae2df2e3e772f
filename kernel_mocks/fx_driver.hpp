// The computer's side of the FX programming port, over any SerialPort.
//
// Every call is one request and its answer, repeated when the answer is missing or bad. What may be repeated depends on
// what the port can tell:
//   - Of a line, and of the published handoff, silence is all that is known. Everything is repeated then: writes and forces
//     set levels, and to repeat them is the lesser evil.
//   - The hardened handoff tells what became of a request. One that was not executed is repeated. One that may have been is
//     repeated if it reads or is ENQ, which changes nothing. A write or force is not: in between the PLC may have answered
//     to it and changed the device back, and would act twice.
//
// After a failed exchange the line may still hold, or later bring, an answer that belongs to nobody: it is
// purged before the next request. An answer that arrives after that purge cannot be told from the right one:
// the protocol numbers nothing. What catches most of them: the kind (data or ACK) and the length of each
// answer are checked.
//
// Not for two threads at once, as the line itself is not.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "protocol/fx/address_map.hpp"
#include "protocol/fx/frame.hpp"
#include "protocol/serial_port.hpp"

namespace kernel_mocks {

enum class FxDriverError : std::uint8_t {
  not_reachable,      ///< the model has no such device, or no command of this protocol shows it
  bad_length,         ///< no bytes, or more than one request carries
  port_failed,        ///< the port reported an error: last_port_error()
  write_timed_out,    ///< the carrier did not take the whole request in time
  no_answer,          ///< nothing came before the time-out
  truncated_answer,   ///< a frame began and did not end before the time-out
  nak,                ///< the PLC refused
  bad_frame,          ///< an answer that is no frame: too long, wrong digits
  bad_checksum,       ///< the sum of the answer is wrong
  wrong_length,       ///< an answer with more or fewer bytes than asked for
  unexpected_answer,  ///< data where ACK belongs, ACK where data belong, or ENQ
  surplus_bytes,      ///< something followed the answer at once: a doubled answer
  not_executed,       ///< the PLC did not take the request, in no repetition
  outcome_unknown,    ///< a write or force that the PLC may have executed: request_in_doubt()
};
inline constexpr std::size_t fx_driver_error_count = 14;

[[nodiscard]] std::string_view to_string(FxDriverError error) noexcept;

/// A write or force of which nobody knows whether the PLC has executed it.
struct RequestInDoubt {
  protocol::fx::Command command;
  protocol::fx::Device device;  ///< the first one
  std::uint8_t count_bytes;     ///< of a write
  protocol::PortError reason;   ///< one that is_in_doubt()
};

/// "write 1 byte from M96 on: the message was taken and not answered in time"
[[nodiscard]] std::string to_string(const RequestInDoubt& in_doubt);

struct FxDriverOptions {
  protocol::fx::Model model = protocol::fx::Model::fx3u;
  /// From the request to the end of its answer. The longest answer lasts 533 ms at 9600 bit/s.
  std::chrono::nanoseconds answer_timeout = std::chrono::milliseconds{200};
  /// Longest wait until the port has taken a request; of the hardened handoff, until the PLC has. What was not executed is
  /// not repeated before this has passed.
  std::chrono::nanoseconds send_timeout = std::chrono::milliseconds{200};
  /// Repetitions of a request after its first failure.
  unsigned retries = 2;
  /// Tries of ENQ; three unanswered ones mean that there is no PLC.
  unsigned enq_tries = 3;
  /// Fixed pauses before the answer is looked for, as drivers of slow ports make them (20 ms and 40 ms where
  /// they are published). Zero: read() itself waits, which loses nothing.
  std::chrono::nanoseconds enq_wait{0};
  std::chrono::nanoseconds request_wait{0};
};

class FxDriver {
 public:
  struct Counters {
    std::uint64_t requests = 0;   ///< asked for by the caller
    std::uint64_t retries = 0;    ///< frames sent again, ENQ included
    std::uint64_t time_outs = 0;  ///< answers that did not come, or not to their end
  };

  /// @param port  must outlive the driver; opened by connect()
  FxDriver(protocol::SerialPort& port, const FxDriverOptions& options);

  /// Opens the port if need be, and asks with ENQ whether somebody is there.
  [[nodiscard]] tl::expected<void, FxDriverError> connect() noexcept;

  /// Reads consecutive bytes: of a bit device eight bits each, beginning with the byte that holds `first`.
  /// @param into  1 to 64 bytes (254 where only the wide commands reach)
  [[nodiscard]] tl::expected<void, FxDriverError> read_bytes(protocol::fx::Device first,
                                                             std::span<std::byte> into) noexcept;
  /// Writes consecutive bytes with one request.
  [[nodiscard]] tl::expected<void, FxDriverError> write_bytes(protocol::fx::Device first,
                                                              std::span<const std::byte> bytes) noexcept;
  /// Sets or resets one bit device.
  [[nodiscard]] tl::expected<void, FxDriverError> force(protocol::fx::Device device, bool on) noexcept;

  [[nodiscard]] tl::expected<std::uint16_t, FxDriverError> read_word(protocol::fx::Device word) noexcept;
  /// Writes consecutive words with one request.
  [[nodiscard]] tl::expected<void, FxDriverError> write_words(protocol::fx::Device first,
                                                              std::span<const std::uint16_t> words) noexcept;

  [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
  /// What the port said when port_failed, not_executed or outcome_unknown was returned last, or retried.
  [[nodiscard]] protocol::PortError last_port_error() const noexcept { return last_port_error_; }
  /// The first request that ended with outcome_unknown; what follows it, as a reset, may end so, too.
  [[nodiscard]] const std::optional<RequestInDoubt>& request_in_doubt() const noexcept {
    return request_in_doubt_;
  }

 private:
  using Event = protocol::fx::FrameReceiver::Event;

  tl::expected<void, FxDriverError> request(protocol::fx::Device device, const protocol::fx::Request& request,
                                            std::span<std::byte> answer) noexcept;
  /// Counts a repetition, and waits before it if need be.
  void repeat(FxDriverError after) noexcept;
  tl::expected<void, FxDriverError> try_once(std::span<const std::byte> frame,
                                             std::span<std::byte> answer) noexcept;
  tl::expected<void, FxDriverError> send(std::span<const std::byte> frame) noexcept;
  tl::expected<Event, FxDriverError> receive() noexcept;
  tl::expected<void, FxDriverError> take_data(std::span<std::byte> answer) const noexcept;
  tl::unexpected<FxDriverError> failed(protocol::PortError error) noexcept;

  protocol::SerialPort& port_;
  FxDriverOptions options_;
  protocol::fx::FrameReceiver receiver_;
  Counters counters_;
  protocol::PortError last_port_error_ = protocol::PortError::not_open;
  std::optional<RequestInDoubt> request_in_doubt_;
  std::chrono::steady_clock::time_point sent_at_;
  bool line_is_clean_ = true;
};

}  // namespace kernel_mocks
