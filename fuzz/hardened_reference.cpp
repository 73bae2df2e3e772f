#include "fuzz/hardened_reference.hpp"

#include <algorithm>

namespace fuzz::reference {

namespace {

using protocol::hardened::MessageError;

constexpr std::size_t checksum_offset = 36;

void append(std::vector<std::byte>& bytes, std::uint64_t number, unsigned count) {
  for (unsigned i = 0; i < count; ++i) bytes.push_back(static_cast<std::byte>(number >> 8 * i));
}

std::uint64_t number_at(std::span<const std::byte> bytes, std::size_t offset, unsigned count) {
  std::uint64_t number = 0;
  for (unsigned i = 0; i < count; ++i) number |= std::to_integer<std::uint64_t>(bytes[offset + i]) << 8 * i;
  return number;
}

/// RFC 3720, annex B.4, one bit a step; the checksum itself counts as 0.
std::uint32_t checksum_of(std::span<const std::byte> bytes) {
  std::uint32_t remainder = ~0U;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const bool is_checksum = i >= checksum_offset && i < checksum_offset + 4;
    remainder ^= is_checksum ? 0U : std::to_integer<std::uint32_t>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) remainder = remainder >> 1U ^ (remainder & 1U) * 0x82F6'3B78U;
  }
  return ~remainder;
}

}  // namespace

std::vector<std::byte> encode(Kind kind, const Message& message) {
  std::vector<std::byte> bytes;
  for (const char letter : {'L', 'R', static_cast<char>(kind), '\1'})
    bytes.push_back(static_cast<std::byte>(letter));
  append(bytes, message.flags_or_status, 4);
  append(bytes, message.session, 8);
  append(bytes, message.sequence, 8);
  append(bytes, message.slave, 8);
  append(bytes, message.payload.size(), 4);
  append(bytes, 0, 4);
  bytes.insert(bytes.end(), message.payload.begin(), message.payload.end());
  seal(bytes);
  return bytes;
}

std::optional<MessageError> decode(Kind kind, std::span<const std::byte> bytes, Message& into) {
  if (bytes.size() < header_bytes) return MessageError::too_short;
  if (bytes[0] != std::byte{'L'} || bytes[1] != std::byte{'R'} || bytes[2] != static_cast<std::byte>(kind))
    return MessageError::wrong_magic;
  if (bytes[3] != std::byte{1}) return MessageError::wrong_version;
  if (number_at(bytes, 32, 4) != bytes.size() - header_bytes) return MessageError::wrong_length;
  if (number_at(bytes, checksum_offset, 4) != checksum_of(bytes)) return MessageError::wrong_checksum;
  const auto flags_or_status = static_cast<std::uint32_t>(number_at(bytes, 4, 4));
  if (kind == Kind::request && flags_or_status != 0) return MessageError::unknown_flags;
  if (kind == Kind::response && flags_or_status > 3) return MessageError::unknown_status;
  const auto payload = bytes.subspan(header_bytes);
  into = {.flags_or_status = flags_or_status,
          .session = number_at(bytes, 8, 8),
          .sequence = number_at(bytes, 16, 8),
          .slave = number_at(bytes, 24, 8),
          .payload = {payload.begin(), payload.end()}};
  return std::nullopt;
}

void seal(std::span<std::byte> bytes) {
  if (bytes.size() < header_bytes) return;
  const std::uint32_t checksum = checksum_of(bytes);
  for (unsigned i = 0; i < 4; ++i) bytes[checksum_offset + i] = static_cast<std::byte>(checksum >> 8 * i);
}

}  // namespace fuzz::reference
