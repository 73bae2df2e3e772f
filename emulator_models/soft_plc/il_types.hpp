// The elementary types of instruction list, and how a value of each lies in a byte memory and in the
// accumulator.
//
// In a memory a value has the bytes of its type, low byte first; a BOOL has a whole byte, 0 or 1. In the
// accumulator it is 64 bits wide: signed integers and TIME extended by their sign, all others by zero, REAL and
// LREAL as their IEEE 754 pattern. TIME counts nanoseconds: it wraps after 292 years, not after 24 days.
// Not here: DATE, TOD, DT and STRING, which this PLC has not.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace emulator_models::soft_plc {

static_assert(std::endian::native == std::endian::little, "values are copied, not assembled byte by byte");

enum class ElementaryType : std::uint8_t {
  boolean,
  sint,
  int_,
  dint,
  lint,
  usint,
  uint,
  udint,
  ulint,
  byte,
  word,
  dword,
  lword,
  real,
  lreal,
  time,
};
inline constexpr std::size_t elementary_types_count = 16;

/// The name as the standard writes it: "INT".
[[nodiscard]] std::string_view name_of(ElementaryType type) noexcept;
/// @param upper_name  in capitals
[[nodiscard]] std::optional<ElementaryType> elementary_type(std::string_view upper_name) noexcept;

[[nodiscard]] std::size_t size_bytes(ElementaryType type) noexcept;
[[nodiscard]] bool is_signed_integer(ElementaryType type) noexcept;
[[nodiscard]] bool is_integer(ElementaryType type) noexcept;
[[nodiscard]] bool is_real(ElementaryType type) noexcept;
/// ANY_NUM: integers and reals, not TIME.
[[nodiscard]] bool is_number(ElementaryType type) noexcept;
/// ANY_BIT: BOOL, BYTE, WORD, DWORD, LWORD.
[[nodiscard]] bool is_bits(ElementaryType type) noexcept;

/// What the accumulator holds after the low bytes of `bits` were stored as `type` and loaded again: this is
/// how arithmetic wraps.
[[nodiscard]] std::uint64_t wrapped(ElementaryType type, std::uint64_t bits) noexcept;

/// @param from  at least size_bytes(type) bytes, of any alignment
[[nodiscard]] std::uint64_t load(ElementaryType type, const std::byte* from) noexcept;
void store(ElementaryType type, std::byte* to, std::uint64_t bits) noexcept;

[[nodiscard]] inline float as_real(std::uint64_t bits) noexcept {
  return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
}
[[nodiscard]] inline double as_lreal(std::uint64_t bits) noexcept { return std::bit_cast<double>(bits); }
[[nodiscard]] inline std::uint64_t bits_of(float value) noexcept {
  return std::bit_cast<std::uint32_t>(value);
}
[[nodiscard]] inline std::uint64_t bits_of(double value) noexcept {
  return std::bit_cast<std::uint64_t>(value);
}

}  // namespace emulator_models::soft_plc
