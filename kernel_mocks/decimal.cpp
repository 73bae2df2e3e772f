#include "kernel_mocks/decimal.hpp"

#include <fmt/format.h>

namespace kernel_mocks {

tl::expected<Decimal, DecimalError> Decimal::parse(std::string_view text) noexcept {
  bool negative = false;
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) {
    negative = text.front() == '-';
    text.remove_prefix(1);
  }
  const std::size_t point = text.find('.');
  std::string_view whole_digits = text.substr(0, point);
  std::string_view fraction_digits =
      point == std::string_view::npos ? std::string_view{} : text.substr(point + 1);
  if (whole_digits.empty() && fraction_digits.empty()) return tl::unexpected{DecimalError::not_a_number};
  for (const std::string_view digits : {whole_digits, fraction_digits}) {
    for (const char c : digits) {
      if (c < '0' || c > '9') return tl::unexpected{DecimalError::not_a_number};
    }
  }
  while (!whole_digits.empty() && whole_digits.front() == '0') whole_digits.remove_prefix(1);
  while (!fraction_digits.empty() && fraction_digits.back() == '0') fraction_digits.remove_suffix(1);
  if (whole_digits.size() > decimal_digits_max || fraction_digits.size() > decimal_digits_max) {
    return tl::unexpected{DecimalError::too_many_digits};
  }

  std::int64_t units = 0;
  for (const char c : whole_digits) units = units * 10 + (c - '0');
  for (unsigned place = 0; place < decimal_digits_max; ++place) {
    units = units * 10 + (place < fraction_digits.size() ? fraction_digits[place] - '0' : 0);
  }
  return Decimal{negative ? -units : units};
}

std::string to_string(Decimal value) {
  const std::int64_t magnitude = value.is_negative() ? -value.units() : value.units();
  std::string text = fmt::format("{}{}", value.is_negative() ? "-" : "", magnitude / Decimal::units_per_one);
  if (!value.is_whole()) {
    text += fmt::format(".{:09}", magnitude % Decimal::units_per_one);
    while (text.back() == '0') text.pop_back();
  }
  return text;
}

}  // namespace kernel_mocks
