#include "emulator_models/soft_plc/il_address.hpp"

#include <charconv>
#include <optional>

#include "emulator_models/soft_plc/il_lexer.hpp"

namespace emulator_models::soft_plc {
namespace {

std::optional<Area> area_of(char letter) noexcept {
  switch (letter) {
    case 'I':
      return Area::inputs;
    case 'Q':
      return Area::outputs;
    case 'M':
      return Area::memory;
    default:
      return std::nullopt;
  }
}

std::optional<ElementaryType> type_of(char letter) noexcept {
  switch (letter) {
    case 'X':
      return ElementaryType::boolean;
    case 'B':
      return ElementaryType::byte;
    case 'W':
      return ElementaryType::word;
    case 'D':
      return ElementaryType::dword;
    case 'L':
      return ElementaryType::lword;
    default:
      return std::nullopt;
  }
}

std::optional<std::uint32_t> number_of(std::string_view digits) noexcept {
  std::uint32_t number = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stopped, error] = std::from_chars(digits.data(), end, number);
  if (error != std::errc{} || stopped != end) return std::nullopt;
  return number;
}

}  // namespace

tl::expected<DirectAddress, std::string> parse_address(std::string_view text) {
  const std::string capitals = upper(text);
  const std::string shown{text};
  const auto wrong = [&](const std::string& why) { return tl::unexpected(shown + " is no address: " + why); };
  const std::string how = "it looks like %IX0.0, %Q1.7, %MB3, %MW5, %MD2 or %ML1";

  if (capitals.size() < 3) return wrong(how);
  DirectAddress address;
  const auto area = area_of(capitals[1]);
  if (!area) return wrong("the areas are I (inputs), Q (outputs) and M (memory)");
  address.area = *area;
  std::string_view numbers = std::string_view{capitals}.substr(2);
  if (const auto type = type_of(numbers.front())) {
    address.type = *type;
    numbers.remove_prefix(1);
  }

  const std::size_t dot = numbers.find('.');
  const bool is_bit = address.type == ElementaryType::boolean;
  if (is_bit != (dot != std::string_view::npos))
    return wrong(is_bit ? "a bit has two numbers, byte.bit: %IX0.3" : "B, W, D and L take one number");
  const auto number = number_of(numbers.substr(0, dot));
  if (!number) return wrong(how);
  if (is_bit) {
    const auto bit = number_of(numbers.substr(dot + 1));
    if (!bit || *bit > 7) return wrong("the bits of a byte are 0 to 7");
    address.bit_index = static_cast<std::uint8_t>(*bit);
  }
  const std::uint64_t size = size_bytes(address.type);
  if ((*number + std::uint64_t{1}) * size > image_bytes_max)
    return wrong("an area has at most " + std::to_string(image_bytes_max) + " bytes");
  address.byte_index = static_cast<std::uint32_t>(*number * size);
  return address;
}

}  // namespace emulator_models::soft_plc
