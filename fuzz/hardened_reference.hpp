// The messages of the hardened handoff a second time, from the table in protocol/hardened/message.hpp: what targets compare with.
//
// Slow and plain: the checksum bit by bit, the numbers byte by byte. Shares with the code under test the names of defects only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "protocol/hardened/message.hpp"

namespace fuzz::reference {

inline constexpr std::size_t header_bytes = 40;

enum class Kind : char { request = 'Q', response = 'S' };

/// One message, whatever it asks for: flags and states that nobody has defined, too.
struct Message {
  std::uint32_t flags_or_status = 0;
  std::uint64_t session = 0;
  std::uint64_t sequence = 0;
  std::uint64_t slave = 0;
  std::vector<std::byte> payload;

  bool operator==(const Message&) const = default;
};

/// @return the message, whole
[[nodiscard]] std::vector<std::byte> encode(Kind kind, const Message& message);

/// @param into  where the message is put, if there is nothing wrong with it
/// @return      the first defect
[[nodiscard]] std::optional<protocol::hardened::MessageError> decode(Kind kind,
                                                                     std::span<const std::byte> bytes,
                                                                     Message& into);

/// Puts in place the checksum that the bytes ask for; nothing if they are less than a header.
void seal(std::span<std::byte> bytes);

/// The header before a payload that a side has handed out: both lie in its copy of one message.
[[nodiscard]] inline std::span<const std::byte> message_around(std::span<const std::byte> payload) noexcept {
  return {payload.data() - header_bytes, header_bytes + payload.size()};
}

}  // namespace fuzz::reference
