#include "sim_clock/explore/frames.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace ltsim {

std::vector<std::uint8_t> as_frame(std::span<const std::uint8_t> bytes) {
  const auto length = static_cast<std::uint32_t>(bytes.size());
  std::vector<std::uint8_t> frame(sizeof length + bytes.size());
  std::memcpy(frame.data(), &length, sizeof length);
  if (!bytes.empty()) std::memcpy(frame.data() + sizeof length, bytes.data(), bytes.size());
  return frame;
}

bool write_all(int descriptor, std::span<const std::uint8_t> bytes) noexcept {
  while (!bytes.empty()) {
    // Whoever has died must not take the writer with it.
    const ssize_t count = send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

std::optional<std::vector<std::uint8_t>> FrameReader::next() {
  std::uint32_t length = 0;
  if (buffer_.size() < sizeof length) return std::nullopt;
  std::memcpy(&length, buffer_.data(), sizeof length);
  if (buffer_.size() - sizeof length < length) return std::nullopt;
  const auto begin = buffer_.begin() + sizeof length;
  std::vector<std::uint8_t> frame{begin, begin + length};
  buffer_.erase(buffer_.begin(), begin + length);
  return frame;
}

bool write_text(int descriptor, std::string_view text) {
  return write_all(descriptor,
                   as_frame(std::span{reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
}

std::optional<std::string> read_text(int descriptor, FrameReader& reader) {
  std::array<std::uint8_t, 16 * 1024> part{};
  for (;;) {
    if (const auto frame = reader.next()) return std::string{frame->begin(), frame->end()};
    const ssize_t count = read(descriptor, part.data(), part.size());
    if (count == 0 || (count < 0 && errno != EINTR)) return std::nullopt;
    if (count > 0) reader.add(std::span{part}.first(static_cast<std::size_t>(count)));
  }
}

}  // namespace ltsim
