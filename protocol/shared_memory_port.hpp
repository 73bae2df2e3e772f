// A PLC emulator behind the serial port that the kernel knows.
//
// Each write() is one request of the exchange, each answer one response. What of an answer does not fit into
// the reader's buffer stays in the port for the next read(), so a reader may take an answer in pieces; a
// writer may not send a request in pieces (hazard H22). purge() clears what the port has received: an answer
// that has not been taken from the segment is not touched, and shows up in a later read().
//
// Not for two threads at once: the published design has no lock here (hazard H15).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "protocol/master_shared_memory_wrapper.hpp"
#include "protocol/serial_port.hpp"

namespace protocol {

class SharedMemoryPort final : public SerialPort {
 public:
  /// @param observer  see SharedMemoryWrapper
  SharedMemoryPort(std::string segment_name, const PaperOptions& options,
                   ExchangeObserver* observer = nullptr);

  [[nodiscard]] tl::expected<void, PortError> open() noexcept override;
  void close() noexcept override;
  [[nodiscard]] bool is_open() const noexcept override;

  /// Sends all bytes as one request. No bytes: no request.
  /// @return message_too_long: nothing was sent; refused (K4 = one): the request may be executed all the same
  [[nodiscard]] tl::expected<std::size_t, PortError> write(
      std::span<const std::byte> bytes) noexcept override;
  [[nodiscard]] tl::expected<std::size_t, PortError> read(std::span<std::byte> into) noexcept override;

  /// The read time-out takes the place of PaperOptions::read_timeout. The write time-out has no meaning here:
  /// a write never waits.
  void set_timeouts(const PortTimeouts& timeouts) noexcept override;
  void purge() noexcept override;

 private:
  MasterSharedMemoryWrapper wrapper_;
  std::vector<std::byte> received_;         // room for the longest answer
  std::span<const std::byte> unread_ = {};  // the part of received_ that no read() has taken yet
};

}  // namespace protocol
