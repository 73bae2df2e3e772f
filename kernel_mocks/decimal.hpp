// A number of a part program, exact: fixed point with nine decimal places.
//
// Part programs carry decimal numbers, and some of them are codes (G92.1, M3.5): a binary fraction would have
// to be compared with a tolerance. Fixed point also gives every machine and every run the same value.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace kernel_mocks {

/// Digits before and after the decimal point, without leading and trailing zeros: 10^9 x 10^9 fits 64 bits.
inline constexpr unsigned decimal_digits_max = 9;

enum class DecimalError : std::uint8_t {
  not_a_number,     ///< no digit, two points, or a sign that is not in front
  too_many_digits,  ///< more than decimal_digits_max before or after the point
};

class Decimal {
 public:
  static constexpr std::int64_t units_per_one = 1'000'000'000;

  constexpr Decimal() = default;
  [[nodiscard]] static constexpr Decimal from_whole(std::int32_t value) noexcept {
    return Decimal{value * units_per_one};
  }
  /// @param text  an optional sign, digits, at most one decimal point; no blanks
  [[nodiscard]] static tl::expected<Decimal, DecimalError> parse(std::string_view text) noexcept;

  [[nodiscard]] constexpr bool is_whole() const noexcept { return units_ % units_per_one == 0; }
  [[nodiscard]] constexpr bool is_negative() const noexcept { return units_ < 0; }
  [[nodiscard]] constexpr bool is_zero() const noexcept { return units_ == 0; }
  /// The part before the decimal point.
  [[nodiscard]] constexpr std::int64_t whole() const noexcept { return units_ / units_per_one; }
  /// In 10^-9.
  [[nodiscard]] constexpr std::int64_t units() const noexcept { return units_; }

  constexpr bool operator==(const Decimal&) const = default;

 private:
  explicit constexpr Decimal(std::int64_t units) noexcept : units_{units} {}

  std::int64_t units_ = 0;
};

/// The shortest way to write it: "3.5", "-0.25", "40".
[[nodiscard]] std::string to_string(Decimal value);

}  // namespace kernel_mocks
