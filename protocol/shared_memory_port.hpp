// A PLC emulator behind the serial port that the kernel knows, by the published handoff or the hardened one.
//
// Each write() is one request of the exchange, each answer one response. What of an answer does not fit into
// the reader's buffer stays in the port for the next read(), so a reader may take an answer in pieces; a
// writer may not send a request in pieces (hazard H22). purge() clears what the port has received: an answer
// that has not been taken from the segment is not touched, and shows up in a later read(), unless the hardened handoff
// has given it up for the next write().
//
// Not for two threads at once: the published design has no lock here (hazard H15), and the hardened one is for one
// thread a side.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "protocol/exchange_observer.hpp"
#include "protocol/exchange_sides.hpp"
#include "protocol/hardened/options.hpp"
#include "protocol/paper_options.hpp"
#include "protocol/serial_port.hpp"

namespace protocol {

class SharedMemoryPort final : public SerialPort {
 public:
  /// @param observer  see SharedMemoryWrapper
  SharedMemoryPort(std::string segment_name, const PaperOptions& options,
                   ExchangeObserver* observer = nullptr);
  SharedMemoryPort(std::string segment_name, const hardened::Options& options,
                   ExchangeObserver* observer = nullptr);

  [[nodiscard]] tl::expected<void, PortError> open() noexcept override;
  void close() noexcept override;
  [[nodiscard]] bool is_open() const noexcept override;

  /// Sends all bytes as one request. No bytes: no request.
  /// @return message_too_long: nothing was sent; refused: paper, K4 = one: the request may be executed all the same;
  ///         not_executed (hardened): nobody serves, or the slave is busy
  [[nodiscard]] tl::expected<std::size_t, PortError> write(
      std::span<const std::byte> bytes) noexcept override;
  /// @return hardened: how the request ended, unless it was answered: not_executed, unanswered, receiver_gone, damaged.
  ///         The published handoff knows no more than that no bytes came
  [[nodiscard]] tl::expected<std::size_t, PortError> read(std::span<std::byte> into) noexcept override;

  /// The read time-out takes the place of PaperOptions::read_timeout, or of hardened::Options::answer_timeout. The write
  /// time-out takes that of hardened::Options::take_timeout; in the published handoff it has no meaning.
  void set_timeouts(const PortTimeouts& timeouts) noexcept override;
  void purge() noexcept override;

 private:
  explicit SharedMemoryPort(std::unique_ptr<ExchangeMaster> master);

  std::unique_ptr<ExchangeMaster> master_;
  std::vector<std::byte> received_;         // room for the longest answer
  std::span<const std::byte> unread_ = {};  // the part of received_ that no read() has taken yet
};

}  // namespace protocol
