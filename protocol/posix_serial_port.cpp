#include "protocol/posix_serial_port.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include "protocol/deadline.hpp"

namespace protocol {

namespace {

using Clock = std::chrono::steady_clock;

std::optional<speed_t> speed(unsigned baud_rate) noexcept {
  switch (baud_rate) {
    case 9600:
      return B9600;
    case 19200:
      return B19200;
    case 38400:
      return B38400;
    case 57600:
      return B57600;
    case 115200:
      return B115200;
    default:
      return std::nullopt;
  }
}

/// Linux gives the slaves of pseudo-terminals the device numbers 136 to 143
/// (Documentation/admin-guide/devices.txt).
bool is_pseudo_terminal(int descriptor) noexcept {
  struct stat status = {};
  if (::fstat(descriptor, &status) != 0) return false;
  const unsigned device_major = major(status.st_rdev);
  return device_major >= 136 && device_major <= 143;
}

/// Sets the line and looks whether it took: tcsetattr() also succeeds when only a part of it could be set.
bool configure(int descriptor, const LineSettings& settings) noexcept {
  const auto line_speed = speed(settings.baud_rate);
  termios line = {};
  if (!line_speed || ::tcgetattr(descriptor, &line) != 0) return false;
  ::cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS | PARODD);
  line.c_iflag &= ~static_cast<tcflag_t>(IXON | IXOFF | IXANY | INPCK);
  if (settings.characters == LineSettings::Characters::seven_even_one && !is_pseudo_terminal(descriptor)) {
    line.c_cflag &= ~static_cast<tcflag_t>(CSIZE);
    line.c_cflag |= CS7 | PARENB;
    line.c_iflag |= INPCK;
  }
  line.c_cc[VMIN] = 1;  // so that a read() of 0 bytes means a hang-up, not silence
  line.c_cc[VTIME] = 0;
  ::cfsetispeed(&line, *line_speed);
  ::cfsetospeed(&line, *line_speed);
  if (::tcsetattr(descriptor, TCSANOW, &line) != 0) return false;

  termios taken = {};
  constexpr tcflag_t compared = CSIZE | PARENB | PARODD | CSTOPB;
  return ::tcgetattr(descriptor, &taken) == 0 && ((taken.c_cflag ^ line.c_cflag) & compared) == 0 &&
         ::cfgetospeed(&taken) == *line_speed;
}

/// Waits until the line is ready for `events`.
/// @return false at the deadline
tl::expected<bool, PortError> wait_until_ready(int descriptor, short events,
                                               Clock::time_point deadline) noexcept {
  for (;;) {
    const auto remaining = std::max(deadline - Clock::now(), Clock::duration::zero());
    // Rounded up, so that the last fraction of a millisecond is slept and not spun; a wait beyond poll()'s
    // range goes round again.
    const auto remaining_ms = std::chrono::ceil<std::chrono::milliseconds>(remaining).count();
    constexpr decltype(remaining_ms) longest_ms = 1'000'000;
    pollfd line = {.fd = descriptor, .events = events, .revents = 0};
    const int ready_count = ::poll(&line, 1, static_cast<int>(std::min(remaining_ms, longest_ms)));
    if (ready_count > 0) {
      if ((line.revents & events) != 0) return true;
      return tl::unexpected(PortError::line_lost);  // POLLHUP, POLLERR or POLLNVAL and nothing else
    }
    if (ready_count < 0 && errno != EINTR) return tl::unexpected(PortError::line_lost);
    if (Clock::now() >= deadline) return false;
  }
}

bool is_worth_waiting(int error) noexcept { return error == EAGAIN || error == EINTR; }

}  // namespace

PosixSerialPort::PosixSerialPort(std::string device_path, const LineSettings& settings)
    : device_path_(std::move(device_path)), settings_(settings) {}

PosixSerialPort::~PosixSerialPort() { close(); }

tl::expected<void, PortError> PosixSerialPort::open() noexcept {
  if (is_open()) return {};
  descriptor_ = ::open(device_path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0)
    return tl::unexpected(errno == EBUSY ? PortError::already_in_use : PortError::cannot_open);
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    close();
    return tl::unexpected(PortError::already_in_use);
  }
  if (!configure(descriptor_, settings_)) {
    close();
    return tl::unexpected(PortError::cannot_open);
  }
  return {};
}

void PosixSerialPort::close() noexcept {
  if (is_open()) ::close(std::exchange(descriptor_, -1));
}

bool PosixSerialPort::is_open() const noexcept { return descriptor_ >= 0; }

tl::expected<std::size_t, PortError> PosixSerialPort::write(std::span<const std::byte> bytes) noexcept {
  if (!is_open()) return tl::unexpected(PortError::not_open);
  const auto deadline = deadline_after(timeouts_.write);
  std::size_t written_bytes = 0;
  while (written_bytes < bytes.size()) {
    const auto rest = bytes.subspan(written_bytes);
    const ssize_t taken = ::write(descriptor_, rest.data(), rest.size());
    if (taken >= 0) {
      written_bytes += static_cast<std::size_t>(taken);
      continue;
    }
    if (!is_worth_waiting(errno)) return tl::unexpected(PortError::line_lost);
    const auto ready = wait_until_ready(descriptor_, POLLOUT, deadline);
    if (!ready) return tl::unexpected(ready.error());
    if (!*ready) break;
  }
  return written_bytes;
}

tl::expected<std::size_t, PortError> PosixSerialPort::read(std::span<std::byte> into) noexcept {
  if (!is_open()) return tl::unexpected(PortError::not_open);
  if (into.empty()) return 0;
  const auto deadline = deadline_after(timeouts_.read);
  for (;;) {
    const auto ready = wait_until_ready(descriptor_, POLLIN, deadline);
    if (!ready) return tl::unexpected(ready.error());
    if (!*ready) return 0;
    const ssize_t received = ::read(descriptor_, into.data(), into.size());
    if (received > 0) return static_cast<std::size_t>(received);
    if (received == 0 || !is_worth_waiting(errno)) return tl::unexpected(PortError::line_lost);
  }
}

void PosixSerialPort::set_timeouts(const PortTimeouts& timeouts) noexcept { timeouts_ = timeouts; }

void PosixSerialPort::purge() noexcept {
  if (is_open()) ::tcflush(descriptor_, TCIFLUSH);
}

}  // namespace protocol
