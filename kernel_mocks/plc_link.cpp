#include "kernel_mocks/plc_link.hpp"

#include <array>

#include "kernel_mocks/plc_signals.hpp"

namespace kernel_mocks {

tl::expected<std::uint16_t, FxDriverError> PlcLink::read_word(Device word) noexcept {
  std::array<std::byte, 2> bytes{};
  if (const auto done = read_bytes(word, bytes); !done) return tl::unexpected{done.error()};
  return static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[0]) | std::to_integer<unsigned>(bytes[1])
                                                                              << 8U);
}

PlcLink::Done PlcLink::write_words(Device first, std::span<const std::uint16_t> words) noexcept {
  std::array<std::byte, protocol::fx::data_bytes_max_legacy> bytes{};
  if (words.size() * 2 > bytes.size()) return tl::unexpected{FxDriverError::bad_length};
  for (std::size_t index = 0; index < words.size(); ++index) {
    bytes[2 * index] = static_cast<std::byte>(words[index] & 0xFFU);
    bytes[2 * index + 1] = static_cast<std::byte>(words[index] >> 8U);
  }
  return write_bytes(first, std::span{bytes}.first(words.size() * 2));
}

tl::expected<PlcLink::Status, FxDriverError> DirectLink::status() noexcept {
  const std::scoped_lock lock{mutex_};
  const auto read_at = Clock::now();
  std::array<std::byte, 1> byte{};
  if (const auto done = driver_.read_bytes(signals::status_byte, byte); !done) {
    return tl::unexpected{done.error()};
  }
  return Status{byte.front(), read_at};
}

PlcLink::Done DirectLink::read_bytes(Device first, std::span<std::byte> into) noexcept {
  const std::scoped_lock lock{mutex_};
  return driver_.read_bytes(first, into);
}

PlcLink::Done DirectLink::write_bytes(Device first, std::span<const std::byte> bytes) noexcept {
  const std::scoped_lock lock{mutex_};
  return driver_.write_bytes(first, bytes);
}

PlcLink::Done DirectLink::force(Device device, bool on) noexcept {
  const std::scoped_lock lock{mutex_};
  return driver_.force(device, on);
}

}  // namespace kernel_mocks
