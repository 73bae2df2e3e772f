// A serial line of the operating system: a tty, or a pseudo-terminal that stands for one.
//
// The line is raw: no echo, no signals, no translation, no flow control, modem lines ignored. The device is
// locked (flock(2)), so that two programs that respect the lock do not share a line by mistake.
//
// Linux forces a pseudo-terminal to 8 bits without parity, and glibc's tcsetattr() reports EINVAL when asked
// for 7 bits or parity (tty driver, TTY_DRIVER_TYPE_PTY); a pseudo-terminal is therefore always set to 8N1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <tl/expected.hpp>

#include "protocol/serial_port.hpp"

namespace protocol {

struct LineSettings {
  enum class Characters : std::uint8_t {
    seven_even_one,  ///< 7 data bits, even parity, 1 stop bit: the FX programming port
    eight_none_one,  ///< 8 data bits, no parity, 1 stop bit
  };

  /// Bits per second: 9600, 19200, 38400, 57600 or 115200.
  unsigned baud_rate = 9600;
  Characters characters = Characters::seven_even_one;
};

class PosixSerialPort final : public SerialPort {
 public:
  /// @param device_path  "/dev/ttyS0", "/dev/ttyUSB0", "/dev/pts/3"
  explicit PosixSerialPort(std::string device_path, const LineSettings& settings = {});
  PosixSerialPort(const PosixSerialPort&) = delete;
  PosixSerialPort& operator=(const PosixSerialPort&) = delete;
  ~PosixSerialPort() override;

  /// @return cannot_open: no such device, no permission, not a terminal, or it cannot hold the settings;
  ///         already_in_use: another open port holds the lock of the device
  [[nodiscard]] tl::expected<void, PortError> open() noexcept override;
  void close() noexcept override;
  [[nodiscard]] bool is_open() const noexcept override;
  [[nodiscard]] tl::expected<std::size_t, PortError> write(
      std::span<const std::byte> bytes) noexcept override;
  [[nodiscard]] tl::expected<std::size_t, PortError> read(std::span<std::byte> into) noexcept override;
  void set_timeouts(const PortTimeouts& timeouts) noexcept override;
  void purge() noexcept override;

 private:
  std::string device_path_;
  LineSettings settings_;
  PortTimeouts timeouts_;
  int descriptor_ = -1;
};

}  // namespace protocol
