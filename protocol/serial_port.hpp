// The serial port as the CNC kernel sees it.
//
// A port is a stream of bytes with time-outs, whatever carries it: a tty (PosixSerialPort) or the shared
// memory of a PLC emulator (SharedMemoryPort). Code that talks to a PLC knows this class only, so that the
// emulator can take the place of the real PLC without the kernel noticing.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <tl/expected.hpp>

namespace protocol {

/// Why a port operation failed. A time-out is not a failure: it is a result of zero bytes. A carrier that knows what became
/// of a message says so instead.
enum class PortError : std::uint8_t {
  not_open,          ///< the port was never opened, or has been closed
  cannot_open,       ///< no such device or segment, or no permission
  already_in_use,    ///< somebody else holds the device or the role
  message_too_long,  ///< more bytes than the carrier can take in one message
  refused,    ///< the carrier did not accept the bytes (a full semaphore: knob K4 of the paper variant)
  line_lost,  ///< the device went away: hang-up, I/O error
  // Of a carrier that knows what became of a message (the hardened handoff).
  not_executed,   ///< the other side has not executed it, and never will: it may be sent again
  unanswered,     ///< in doubt: the other side has taken it and did not answer in time
  receiver_gone,  ///< in doubt: the one that had taken it has ended, or was started anew
  damaged,        ///< in doubt: the answer was damaged, or too long
};

/// Whether the message may have been executed, and nobody can tell.
[[nodiscard]] constexpr bool is_in_doubt(PortError error) noexcept {
  return error == PortError::unanswered || error == PortError::receiver_gone || error == PortError::damaged;
}

[[nodiscard]] std::string_view to_string(PortError error) noexcept;

struct PortTimeouts {
  /// Longest wait of one read() for its first byte. Zero: whatever is there already.
  std::chrono::nanoseconds read = std::chrono::milliseconds{100};
  /// Longest wait of one write() until the carrier has taken all bytes.
  std::chrono::nanoseconds write = std::chrono::milliseconds{100};
};

class SerialPort {
 public:
  virtual ~SerialPort() = default;

  [[nodiscard]] virtual tl::expected<void, PortError> open() noexcept = 0;
  /// Closing a closed port does nothing.
  virtual void close() noexcept = 0;
  [[nodiscard]] virtual bool is_open() const noexcept = 0;

  /// @return bytes taken by the carrier; fewer than given only after the write time-out
  [[nodiscard]] virtual tl::expected<std::size_t, PortError> write(
      std::span<const std::byte> bytes) noexcept = 0;

  /// Returns as soon as at least one byte is there.
  /// @param into  room for the bytes; what does not fit stays for the next read()
  /// @return      bytes stored; 0 after the read time-out
  [[nodiscard]] virtual tl::expected<std::size_t, PortError> read(std::span<std::byte> into) noexcept = 0;

  virtual void set_timeouts(const PortTimeouts& timeouts) noexcept = 0;

  /// Forgets what was received and not read yet.
  virtual void purge() noexcept = 0;

 protected:
  SerialPort() = default;
  SerialPort(const SerialPort&) = default;
  SerialPort& operator=(const SerialPort&) = default;
};

}  // namespace protocol
