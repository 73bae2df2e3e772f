#include "protocol/hardened/message.hpp"

#include <algorithm>
#include <array>

#include <boost/endian/conversion.hpp>

#include "protocol/check.hpp"
#include "protocol/hardened/crc32c.hpp"

namespace protocol::hardened {

namespace {

namespace endian = boost::endian;

constexpr std::uint32_t version = 1;
constexpr std::uint32_t magic_mask = 0x00FF'FFFF;
constexpr std::uint32_t request_magic = 'L' | 'R' << 8 | 'Q' << 16;
constexpr std::uint32_t response_magic = 'L' | 'R' << 8 | 'S' << 16;

constexpr std::size_t checksum_offset = 36;

/// Both headers have one shape.
struct Header {
  std::uint32_t magic = 0;
  std::uint32_t flags_or_status = 0;
  std::uint64_t session = 0;
  std::uint64_t sequence = 0;
  std::uint64_t slave = 0;
};

std::uint32_t checksum_of(std::span<const std::byte> message) noexcept {
  constexpr std::array<std::byte, header_bytes - checksum_offset> in_place_of_checksum{};
  return crc32c({message.first(checksum_offset), in_place_of_checksum, message.subspan(header_bytes)});
}

std::span<const std::byte> encode(const Header& header, std::span<const std::byte> payload,
                                  std::span<std::byte> into) noexcept {
  PLC_CHECK(into.size() >= header_bytes + payload.size());
  const auto message = into.first(header_bytes + payload.size());
  auto* const at = reinterpret_cast<unsigned char*>(message.data());
  endian::store_little_u32(at, header.magic | version << 24U);
  endian::store_little_u32(at + 4, header.flags_or_status);
  endian::store_little_u64(at + 8, header.session);
  endian::store_little_u64(at + 16, header.sequence);
  endian::store_little_u64(at + 24, header.slave);
  endian::store_little_u32(at + 32, static_cast<std::uint32_t>(payload.size()));
  std::ranges::copy(payload, message.begin() + header_bytes);
  endian::store_little_u32(at + checksum_offset, checksum_of(message));
  return message;
}

tl::expected<Header, MessageError> decode(std::span<const std::byte> message, std::uint32_t magic) noexcept {
  if (message.size() < header_bytes) return tl::unexpected(MessageError::too_short);
  const auto* const at = reinterpret_cast<const unsigned char*>(message.data());
  const std::uint32_t magic_and_version = endian::load_little_u32(at);
  if ((magic_and_version & magic_mask) != magic) return tl::unexpected(MessageError::wrong_magic);
  if (magic_and_version >> 24U != version) return tl::unexpected(MessageError::wrong_version);
  if (endian::load_little_u32(at + 32) != message.size() - header_bytes)
    return tl::unexpected(MessageError::wrong_length);
  if (endian::load_little_u32(at + checksum_offset) != checksum_of(message))
    return tl::unexpected(MessageError::wrong_checksum);
  return Header{.magic = magic,
                .flags_or_status = endian::load_little_u32(at + 4),
                .session = endian::load_little_u64(at + 8),
                .sequence = endian::load_little_u64(at + 16),
                .slave = endian::load_little_u64(at + 24)};
}

}  // namespace

std::string_view to_string(MessageError error) noexcept {
  switch (error) {
    case MessageError::too_short:
      return "shorter than a header";
    case MessageError::wrong_magic:
      return "not this kind of message";
    case MessageError::wrong_version:
      return "of another version of the protocol";
    case MessageError::wrong_length:
      return "not as long as its header says";
    case MessageError::wrong_checksum:
      return "the checksum is wrong";
    case MessageError::unknown_flags:
      return "a flag is set that is not defined";
    case MessageError::unknown_status:
      return "the status is not defined";
  }
  return "unknown message error";
}

std::span<const std::byte> encode(const RequestHeader& header, std::span<const std::byte> payload,
                                  std::span<std::byte> into) noexcept {
  return encode(Header{.magic = request_magic,
                       .session = header.session,
                       .sequence = header.sequence,
                       .slave = header.expected_slave},
                payload, into);
}

std::span<const std::byte> encode(const ResponseHeader& header, std::span<const std::byte> payload,
                                  std::span<std::byte> into) noexcept {
  return encode(Header{.magic = response_magic,
                       .flags_or_status = static_cast<std::uint32_t>(header.status),
                       .session = header.session,
                       .sequence = header.sequence,
                       .slave = header.slave},
                payload, into);
}

tl::expected<Request, MessageError> decode_request(std::span<const std::byte> message) noexcept {
  const auto header = decode(message, request_magic);
  if (!header) return tl::unexpected(header.error());
  if (header->flags_or_status != 0) return tl::unexpected(MessageError::unknown_flags);
  return Request{
      .header = {.session = header->session, .sequence = header->sequence, .expected_slave = header->slave},
      .payload = message.subspan(header_bytes)};
}

tl::expected<Response, MessageError> decode_response(std::span<const std::byte> message) noexcept {
  const auto header = decode(message, response_magic);
  if (!header) return tl::unexpected(header.error());
  if (header->flags_or_status > static_cast<std::uint32_t>(Status::answer_too_long))
    return tl::unexpected(MessageError::unknown_status);
  return Response{.header = {.status = static_cast<Status>(header->flags_or_status),
                             .session = header->session,
                             .sequence = header->sequence,
                             .slave = header->slave},
                  .payload = message.subspan(header_bytes)};
}

}  // namespace protocol::hardened
