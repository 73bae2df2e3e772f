// Which device lies where in the address spaces of the FX programming port.
//
// Two spaces: `legacy` (commands 0, 1, 7, 8) and `wide` (E00, E10, E7, E8). In both, bit devices are packed
// eight to a byte, lowest number in bit 0, and bit number = 8 x byte address + bit (wide: byte address mod
// 8000H). Words lie low byte first. X and Y are numbered in octal: a Device holds their index (X17 has number
// 15), its text form the octal digits.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace protocol::fx {

enum class Model : std::uint8_t { fx1s, fx1n, fx2n, fx3u };

[[nodiscard]] std::string_view to_string(Model model) noexcept;
/// @param name  "FX1S", "FX1N", "FX2N" or "FX3U", in any case
[[nodiscard]] std::optional<Model> parse_model(std::string_view name) noexcept;

enum class DeviceKind : std::uint8_t {
  x,          ///< input, bit
  y,          ///< output, bit
  m,          ///< auxiliary relay, bit; 8000 and up are special
  s,          ///< state, bit
  t_contact,  ///< timer contact, bit
  c_contact,  ///< counter contact, bit
  t_value,    ///< timer current value, 16 bit
  c_value,    ///< counter current value: 16 bit below 200, 32 bit from 200 on
  d,          ///< data register, 16 bit; 8000 and up are special
};

struct Device {
  DeviceKind kind = DeviceKind::d;
  /// For x and y the index, not the octal digits.
  std::uint16_t number = 0;

  bool operator==(const Device&) const = default;
};

/// Bits a device occupies: 1, 16 or 32.
[[nodiscard]] unsigned width_bits(Device device) noexcept;

enum class DeviceError : std::uint8_t {
  not_a_device,  ///< no known letter, no number, or characters left over
  not_octal,     ///< X or Y with a digit 8 or 9
  out_of_range,  ///< the model has no device of that number
};

[[nodiscard]] std::string_view to_string(DeviceError error) noexcept;

/// Reads "X17", "Y20", "M8000", "S0", "D123", "TN10" (timer value), "TS10" (timer contact), "CN200", "CS200",
/// in any case.
[[nodiscard]] tl::expected<Device, DeviceError> parse_device(std::string_view text, Model model) noexcept;
[[nodiscard]] std::string to_string(Device device);
[[nodiscard]] bool exists(Device device, Model model) noexcept;

enum class AddressSpace : std::uint8_t { legacy, wide };

/// Byte address of the device for a read or write; of a bit device, the byte that holds it.
/// @return nothing when the space of that model does not show the device
[[nodiscard]] std::optional<std::uint16_t> byte_address(Device device, Model model,
                                                        AddressSpace space) noexcept;
/// Bit number of a bit device for a force command; nothing for words and where the space does not show it.
[[nodiscard]] std::optional<std::uint16_t> bit_number(Device device, Model model,
                                                      AddressSpace space) noexcept;

/// One byte of the address space, told as devices: the first device that has a part in it, and which part.
struct ByteLocation {
  Device device;                ///< bit device: that of bit 0; word device: the word
  std::uint8_t byte_in_device;  ///< 0 for bit devices; 0, 1 (or 0 to 3) of a word, low byte first
  std::uint8_t devices_count;   ///< bit devices in this byte that exist on the model, 1 to 8; word devices: 1

  bool operator==(const ByteLocation&) const = default;
};

/// @return nothing where the model has no device at that address
[[nodiscard]] std::optional<ByteLocation> locate_byte(std::uint16_t address, Model model,
                                                      AddressSpace space) noexcept;
[[nodiscard]] std::optional<Device> locate_bit(std::uint16_t bit_number, Model model,
                                               AddressSpace space) noexcept;

}  // namespace protocol::fx
