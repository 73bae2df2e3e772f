// A serial port whose answers a test writes down beforehand.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "protocol/serial_port.hpp"

namespace kernel_mocks {

using Bytes = std::vector<std::byte>;

/// "\x05" as bytes.
Bytes bytes_of(std::string_view text);

class ScriptedPort final : public protocol::SerialPort {
 public:
  /// What follows one write: what each read() returns, then silence; then what comes after the time-out.
  struct Reply {
    std::vector<Bytes> pieces;
    std::vector<Bytes> late_pieces;
    /// What read() says instead, once.
    std::optional<protocol::PortError> error = std::nullopt;
  };

  // The script. A write without a reply in the script is followed by silence.
  std::deque<Reply> replies;
  std::optional<protocol::PortError> open_error;
  std::optional<protocol::PortError> write_error;
  std::optional<protocol::PortError> read_error;
  /// Every read returns this byte, for ever.
  std::optional<std::byte> endless_noise;
  /// A write takes no more bytes than this.
  std::size_t write_bytes_max = 1000;

  // The record.
  std::vector<Bytes> written;
  unsigned purges = 0;
  protocol::PortTimeouts timeouts;

  /// A reply that comes as a whole, as a shared-memory port delivers it.
  static Reply whole(std::string_view text) { return {.pieces = {bytes_of(text)}, .late_pieces = {}}; }
  /// A reply that comes byte by byte, as a tty delivers it.
  static Reply bytewise(std::string_view text);
  static Reply silence() { return {}; }
  /// A carrier that knows what became of the message.
  static Reply failure(protocol::PortError error) {
    return {.pieces = {}, .late_pieces = {}, .error = error};
  }
  static Reply after_time_out(std::string_view text) {
    return {.pieces = {}, .late_pieces = {bytes_of(text)}};
  }

  tl::expected<void, protocol::PortError> open() noexcept override;
  void close() noexcept override { open_ = false; }
  bool is_open() const noexcept override { return open_; }
  tl::expected<std::size_t, protocol::PortError> write(std::span<const std::byte> bytes) noexcept override;
  tl::expected<std::size_t, protocol::PortError> read(std::span<std::byte> into) noexcept override;
  void set_timeouts(const protocol::PortTimeouts& wanted) noexcept override { timeouts = wanted; }
  void purge() noexcept override;

 private:
  bool open_ = false;
  std::deque<Bytes> arrived_;
  std::vector<Bytes> late_;
  std::optional<protocol::PortError> error_;
};

}  // namespace kernel_mocks
