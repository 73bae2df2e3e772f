#include "kernel_mocks/axis_limit_text.hpp"

#include <charconv>
#include <cmath>

namespace kernel_mocks {
namespace {

std::optional<double> number(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value, std::chars_format::fixed);
  if (error != std::errc{} || stopped != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::optional<AxisLimit> parse_axis_limit(std::string_view text) {
  if (text.size() < 2 || text[1] != '=') return std::nullopt;
  const std::size_t axis = axis_letters.find(text[0]);
  const std::size_t colon = text.find(':');
  if (axis == std::string_view::npos || colon == std::string_view::npos) return std::nullopt;
  const auto min = number(text.substr(2, colon - 2));
  const auto max = number(text.substr(colon + 1));
  if (!min || !max || *min > 0 || *max < 0) return std::nullopt;
  return AxisLimit{axis, {*min, *max}};
}

}  // namespace kernel_mocks
