#include "emulator_models/pty_server.hpp"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <termios.h>
#include <unistd.h>

namespace emulator_models {
namespace {

bool set_raw(int terminal) noexcept {
  termios line{};
  if (::tcgetattr(terminal, &line) != 0) return false;
  ::cfmakeraw(&line);
  return ::tcsetattr(terminal, TCSANOW, &line) == 0;
}

}  // namespace

PtyServer::PtyServer(IPlcEmulator& plc) noexcept : plc_{plc} {}

PtyServer::~PtyServer() {
  for (const int descriptor : {master_, slave_, stop_event_})
    if (descriptor >= 0) ::close(descriptor);
}

bool PtyServer::open() noexcept {
  stop_event_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  std::array<char, 64> name{};
  if (stop_event_ < 0 || master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
      ::ptsname_r(master_, name.data(), name.size()) != 0)
    return false;
  slave_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (slave_ < 0 || !set_raw(slave_)) return false;
  path_ = name.data();
  return true;
}

void PtyServer::run() noexcept {
  for (;;) {
    std::array<pollfd, 2> waited{pollfd{master_, POLLIN, 0}, pollfd{stop_event_, POLLIN, 0}};
    const int timeout_ms = receiver_.in_frame() ? static_cast<int>(character_timeout.count()) : -1;
    const int ready = ::poll(waited.data(), waited.size(), timeout_ms);
    if (ready == 0) receiver_.reset();
    if (waited[1].revents != 0) return;
    if (ready <= 0 || waited[0].revents == 0) continue;

    std::array<std::byte, 256> bytes;
    const ssize_t count = ::read(master_, bytes.data(), bytes.size());
    if (count < 0 && errno != EAGAIN && errno != EINTR) return;
    for (ssize_t i = 0; i < count; ++i) receive(bytes[static_cast<std::size_t>(i)]);
  }
}

void PtyServer::receive(std::byte byte) noexcept {
  switch (receiver_.receive(byte)) {
    case protocol::fx::FrameReceiver::Event::enq_received:
      answer({&byte, 1});
      return;
    case protocol::fx::FrameReceiver::Event::frame:
      answer(receiver_.frame());
      return;
    case protocol::fx::FrameReceiver::Event::none:
    case protocol::fx::FrameReceiver::Event::ack_received:
    case protocol::fx::FrameReceiver::Event::nak_received:
    case protocol::fx::FrameReceiver::Event::overlong:
      return;  // a PLC has nothing to say to these
  }
}

void PtyServer::answer(std::span<const std::byte> request) noexcept {
  const protocol::fx::FrameBytes response = plc_.process(request);
  std::span<const std::byte> rest = protocol::fx::as_span(response);
  while (!rest.empty()) {
    const ssize_t count = ::write(master_, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;
    rest = rest.subspan(static_cast<std::size_t>(count));
  }
}

void PtyServer::request_stop() noexcept {
  const std::uint64_t one = 1;
  // Fails only when the event is set already.
  [[maybe_unused]] const ssize_t written = ::write(stop_event_, &one, sizeof one);
}

}  // namespace emulator_models
