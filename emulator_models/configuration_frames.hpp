// The messages that carry a configuration to a PLC, in frames that go wherever FX frames go: a serial line of 7 bits, a
// pseudo-terminal, a segment.
//
//   STX  bytes as hexadecimal digits  ETX  SUM     numbers have four bytes, the highest first
//
//   C0  sum     length         begin: CRC-32 and length of the whole text
//   C1  offset  1 to 249 bytes chunk
//   C2  sum                    commit
//   C3  offset  sum            the reason why the commit of that sum was refused, from there on
//
//   D0  request  number        taken
//   D1  request  number  text  refused, up to 248 bytes of the reason
//
// An answer names the request that it belongs to, by its first two fields, so that a late one is not taken for the next.
// Invariant: no request is an FX request, whatever its bytes are; no command of the FX port begins with the letter C. An
// FX PLC answers NAK.
// Decoding takes bytes and returns a value; nothing here reads a clock or a port.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "protocol/fx/frame.hpp"

namespace emulator_models {

enum class TransferCommand : std::uint8_t { begin = 0xC0, chunk = 0xC1, commit = 0xC2, reason = 0xC3 };

inline constexpr std::size_t chunk_bytes_max = protocol::fx::data_bytes_max_wide - 5;
inline constexpr std::size_t reason_part_bytes_max = protocol::fx::data_bytes_max_wide - 6;

struct TransferRequest {
  TransferCommand command = TransferCommand::begin;
  std::uint32_t number = 0;       ///< begin, commit: sum; chunk, reason: offset
  std::uint32_t second = 0;       ///< begin: length; reason: sum; otherwise 0
  protocol::fx::DataBytes bytes;  ///< chunk: 1 to chunk_bytes_max; otherwise empty

  bool operator==(const TransferRequest&) const = default;
};

struct TransferAnswer {
  bool taken = false;
  TransferCommand command = TransferCommand::begin;  ///< of the request
  std::uint32_t number = 0;                          ///< of the request
  protocol::fx::DataBytes text;  ///< refused: at most reason_part_bytes_max of the reason; taken: empty

  bool operator==(const TransferAnswer&) const = default;
};

/// @param request  what does not belong to its command is left out, bytes beyond the bound are, too
[[nodiscard]] protocol::fx::FrameBytes encode(const TransferRequest& request) noexcept;
[[nodiscard]] protocol::fx::FrameBytes encode(const TransferAnswer& answer) noexcept;
/// @param frame  any bytes
/// @return       nothing for all that is not one whole frame with a message as above
[[nodiscard]] std::optional<TransferRequest> decode_transfer_request(
    std::span<const std::byte> frame) noexcept;
[[nodiscard]] std::optional<TransferAnswer> decode_transfer_answer(std::span<const std::byte> frame) noexcept;

}  // namespace emulator_models
