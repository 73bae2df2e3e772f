// What lies in an area: a header of 40 bytes, then the payload.
//
//   offset  size  request          response
//        0     4  magic, version   magic, version     "LRQ" or "LRS", and 1
//        4     4  flags            status             no flag is defined: 0
//        8     8  session          session            the master's number, chosen at its attach
//       16     8  sequence         sequence           of the request, within the session
//       24     8  expected slave   slave              0 in a request: any slave
//       32     4  payload length   payload length     in bytes
//       36     4  CRC-32C          CRC-32C            of header and payload, itself taken as 0
//
// Little endian, at no particular alignment. What is decoded is a copy of an area and may hold anything: every defect is
// a value. The checksum finds a foreign writer and a broken build; it is no argument in the protocol, as a stale answer
// has a perfect one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <tl/expected.hpp>

namespace protocol::hardened {

inline constexpr std::size_t header_bytes = 40;

/// In the order in which they are looked for: the first defect is reported.
enum class MessageError : std::uint8_t {
  too_short,       ///< shorter than a header
  wrong_magic,     ///< not this kind of message
  wrong_version,   ///< of another version of this protocol
  wrong_length,    ///< the payload is not as long as its header says
  wrong_checksum,  ///< altered
  unknown_flags,   ///< a request that asks for something that is not defined
  unknown_status,  ///< a response whose status is not defined
};

[[nodiscard]] std::string_view to_string(MessageError error) noexcept;

/// How a slave answers.
enum class Status : std::uint32_t {
  ok = 0,
  rejected =
      1,  ///< not executed: the request was defective; one that cannot be read has session and sequence 0
  wrong_slave = 2,      ///< not executed: it was for a slave that is not here any more
  answer_too_long = 3,  ///< executed, but its answer has no room in the area
};

struct RequestHeader {
  std::uint64_t session = 0;
  std::uint64_t sequence = 0;
  std::uint64_t expected_slave = 0;

  bool operator==(const RequestHeader&) const = default;
};

struct ResponseHeader {
  Status status = Status::ok;
  std::uint64_t session = 0;
  std::uint64_t sequence = 0;
  std::uint64_t slave = 0;

  bool operator==(const ResponseHeader&) const = default;
};

struct Request {
  RequestHeader header;
  std::span<const std::byte> payload;  ///< part of what was decoded
};

struct Response {
  ResponseHeader header;
  std::span<const std::byte> payload;  ///< part of what was decoded
};

/// @param into  room for header_bytes and the payload
/// @return      the message, the first part of `into`
std::span<const std::byte> encode(const RequestHeader& header, std::span<const std::byte> payload,
                                  std::span<std::byte> into) noexcept;
std::span<const std::byte> encode(const ResponseHeader& header, std::span<const std::byte> payload,
                                  std::span<std::byte> into) noexcept;

/// @param message  all of it, and nothing else
[[nodiscard]] tl::expected<Request, MessageError> decode_request(std::span<const std::byte> message) noexcept;
[[nodiscard]] tl::expected<Response, MessageError> decode_response(
    std::span<const std::byte> message) noexcept;

}  // namespace protocol::hardened
