#include <algorithm>
#include <array>

#include "protocol/fx/address_map.hpp"
#include "protocol/fx/device_ranges.hpp"

namespace protocol::fx {
namespace {

constexpr char to_upper(char c) noexcept {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool equal_in_any_case(std::string_view left, std::string_view right) noexcept {
  return std::equal(left.begin(), left.end(), right.begin(), right.end(),
                    [](char a, char b) { return to_upper(a) == to_upper(b); });
}

constexpr std::array models{Model::fx1s, Model::fx1n, Model::fx2n, Model::fx3u};

struct KindName {
  DeviceKind kind;
  std::string_view letters;
};

constexpr std::array kind_names{
    KindName{DeviceKind::x, "X"},          KindName{DeviceKind::y, "Y"},
    KindName{DeviceKind::m, "M"},          KindName{DeviceKind::s, "S"},
    KindName{DeviceKind::t_contact, "TS"}, KindName{DeviceKind::c_contact, "CS"},
    KindName{DeviceKind::t_value, "TN"},   KindName{DeviceKind::c_value, "CN"},
    KindName{DeviceKind::d, "D"},
};

constexpr bool is_octal(DeviceKind kind) noexcept { return kind == DeviceKind::x || kind == DeviceKind::y; }

constexpr bool counter_exists(unsigned number, Model model) noexcept {
  if (number >= ranges_of(model).c) return false;
  return model != Model::fx1s || number < fx1s_slow_counters_count || number >= fx1s_first_fast_counter;
}

}  // namespace

std::string_view to_string(Model model) noexcept {
  switch (model) {
    case Model::fx1s:
      return "FX1S";
    case Model::fx1n:
      return "FX1N";
    case Model::fx2n:
      return "FX2N";
    case Model::fx3u:
      return "FX3U";
  }
  return "?";
}

std::optional<Model> parse_model(std::string_view name) noexcept {
  for (const Model model : models)
    if (equal_in_any_case(name, to_string(model))) return model;
  return std::nullopt;
}

std::string_view to_string(DeviceError error) noexcept {
  switch (error) {
    case DeviceError::not_a_device:
      return "not a device name";
    case DeviceError::not_octal:
      return "X and Y are numbered in octal: digits 0 to 7 only";
    case DeviceError::out_of_range:
      return "the model has no device of that number";
  }
  return "unknown error";
}

unsigned width_bits(Device device) noexcept { return width_bits_of(device); }

bool exists(Device device, Model model) noexcept {
  const DeviceRanges ranges = ranges_of(model);
  const unsigned number = device.number;
  const auto plain_or_special = [&](unsigned plain_count) {
    return number < plain_count ||
           (number >= first_special_number && number - first_special_number < ranges.special);
  };
  switch (device.kind) {
    case DeviceKind::x:
      return number < ranges.x;
    case DeviceKind::y:
      return number < ranges.y;
    case DeviceKind::m:
      return plain_or_special(ranges.m);
    case DeviceKind::s:
      return number < ranges.s;
    case DeviceKind::t_contact:
    case DeviceKind::t_value:
      return number < ranges.t;
    case DeviceKind::c_contact:
    case DeviceKind::c_value:
      return counter_exists(number, model);
    case DeviceKind::d:
      return plain_or_special(ranges.d);
  }
  return false;
}

tl::expected<Device, DeviceError> parse_device(std::string_view text, Model model) noexcept {
  const std::size_t letters_count = std::min(text.find_first_of("0123456789"), text.size());
  const std::string_view digits = text.substr(letters_count);
  const auto* const name = std::find_if(kind_names.begin(), kind_names.end(), [&](const KindName& known) {
    return equal_in_any_case(known.letters, text.substr(0, letters_count));
  });
  if (name == kind_names.end() || digits.empty()) return tl::unexpected(DeviceError::not_a_device);

  const unsigned base = is_octal(name->kind) ? 8 : 10;
  constexpr unsigned beyond_any_model = 0x10000;
  unsigned number = 0;
  bool has_digit_beyond_base = false;
  for (const char c : digits) {
    if (c < '0' || c > '9') return tl::unexpected(DeviceError::not_a_device);
    const unsigned digit = static_cast<unsigned>(c - '0');
    has_digit_beyond_base = has_digit_beyond_base || digit >= base;
    number = std::min(number * base + digit, beyond_any_model);
  }
  if (has_digit_beyond_base) return tl::unexpected(DeviceError::not_octal);
  const Device device{name->kind, static_cast<std::uint16_t>(number)};
  if (number == beyond_any_model || !exists(device, model)) return tl::unexpected(DeviceError::out_of_range);
  return device;
}

std::string to_string(Device device) {
  const auto* const name = std::find_if(kind_names.begin(), kind_names.end(),
                                        [&](const KindName& known) { return known.kind == device.kind; });
  const unsigned base = is_octal(device.kind) ? 8 : 10;
  std::string digits;
  unsigned rest = device.number;
  do {
    digits.insert(digits.begin(), static_cast<char>('0' + rest % base));
    rest /= base;
  } while (rest != 0);
  return std::string{name->letters} + digits;
}

}  // namespace protocol::fx
