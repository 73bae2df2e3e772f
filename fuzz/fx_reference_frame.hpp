// What a message at the programming port says, worked out a second time: from the protocol's tables, on text, slowly. It
// shares with the codec the names of the defects, and no code.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/fx/frame.hpp"

namespace fuzz {

struct ReferenceMessage {
  enum class Kind : std::uint8_t { read, write, force };

  /// Nothing: it is a request.
  std::optional<protocol::fx::FrameError> defect;
  Kind kind = Kind::read;
  bool is_wide = false;      ///< an E command
  bool is_on = false;        ///< of a force
  unsigned address = 0;      ///< of the first byte; of a force, of the bit
  unsigned count_bytes = 0;  ///< of a read or write
  std::string_view digits;   ///< of what is written, two for a byte; points into the message
};

/// @param message  one that came: STX to sum, or anything else
[[nodiscard]] ReferenceMessage reference_of_request(std::string_view message);

/// @return what is wrong with an answer to a read, if anything is
[[nodiscard]] std::optional<protocol::fx::FrameError> defect_of_reply(std::string_view message);

/// STX, the payload, ETX, the sum.
[[nodiscard]] std::string framed(std::string_view payload);
/// 254 -> "FE" for two digits, "00FE" for four.
[[nodiscard]] std::string hexadecimal(unsigned value, unsigned digits_count);
/// @param digits  hexadecimal ones
[[nodiscard]] unsigned value_of(std::string_view digits);

}  // namespace fuzz
