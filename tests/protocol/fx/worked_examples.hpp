// The worked examples of the FX programming port, as bytes seen on real lines or recomputed by hand. They are
// the oracle of the codec's tests and of the emulator's: none of these bytes was made by the code under test.
//
// Sources: two download sessions with an FX1S and an FX1N (2009), a capture of GX Works2 with an
// FX3U-compatible unit (2025), and the published PC-to-PLC example of reading Y0-Y17.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "protocol/fx/frame.hpp"

namespace protocol::fx::examples {

/// "02 30 41" -> the three bytes. Only for constants of tests: anything else aborts.
[[nodiscard]] std::vector<std::byte> bytes(std::string_view hex);

struct RequestExample {
  std::string_view what;
  std::string_view frame_hex;
  Command command;
  std::uint16_t address;
  std::uint8_t count_bytes;
  std::string_view data_hex;  ///< writes only
};

/// Every request of the worked examples that the codec decodes.
[[nodiscard]] std::span<const RequestExample> requests();

struct ReplyExample {
  std::string_view what;
  std::string_view frame_hex;
  std::string_view data_hex;
};

[[nodiscard]] std::span<const ReplyExample> replies();

}  // namespace protocol::fx::examples
