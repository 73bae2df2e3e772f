// Direct addresses: % area size number, as %IX0.0, %QW3, %MD2.
//
// All sizes of an area share its bytes: %MD0 is %MW0 and %MW1, %MW0 is %MB0 (low) and %MB1, %MB0 is %MX0.0 to
// %MX0.7. The number counts units of the size: %MW3 begins at byte 6. A bit is byte.bit, its X may be left out.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/il_program.hpp"

namespace emulator_models::soft_plc {

/// Bytes of one area that a program can address.
inline constexpr std::uint32_t image_bytes_max = 65'536;

struct DirectAddress {
  Area area = Area::inputs;
  ElementaryType type = ElementaryType::boolean;  ///< BOOL, BYTE, WORD, DWORD, LWORD by the size letter
  std::uint32_t byte_index = 0;
  std::uint8_t bit_index = 0;
};

/// @return the address; or why it is none, and how one looks
[[nodiscard]] tl::expected<DirectAddress, std::string> parse_address(std::string_view text);

}  // namespace emulator_models::soft_plc
