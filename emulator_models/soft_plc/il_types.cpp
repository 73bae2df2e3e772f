#include "emulator_models/soft_plc/il_types.hpp"

#include <array>
#include <cstring>

namespace emulator_models::soft_plc {
namespace {

struct TypeFacts {
  std::string_view name;
  std::uint8_t size_bytes;
};

constexpr std::array<TypeFacts, elementary_types_count> facts{{{"BOOL", 1},
                                                               {"SINT", 1},
                                                               {"INT", 2},
                                                               {"DINT", 4},
                                                               {"LINT", 8},
                                                               {"USINT", 1},
                                                               {"UINT", 2},
                                                               {"UDINT", 4},
                                                               {"ULINT", 8},
                                                               {"BYTE", 1},
                                                               {"WORD", 2},
                                                               {"DWORD", 4},
                                                               {"LWORD", 8},
                                                               {"REAL", 4},
                                                               {"LREAL", 8},
                                                               {"TIME", 8}}};

const TypeFacts& facts_of(ElementaryType type) noexcept { return facts[static_cast<std::size_t>(type)]; }

template <typename Signed>
std::uint64_t sign_extended(std::uint64_t bits) noexcept {
  return static_cast<std::uint64_t>(std::int64_t{static_cast<Signed>(bits)});
}

}  // namespace

std::string_view name_of(ElementaryType type) noexcept { return facts_of(type).name; }

std::optional<ElementaryType> elementary_type(std::string_view upper_name) noexcept {
  for (std::size_t index = 0; index < facts.size(); ++index) {
    if (facts[index].name == upper_name) return static_cast<ElementaryType>(index);
  }
  return std::nullopt;
}

std::size_t size_bytes(ElementaryType type) noexcept { return facts_of(type).size_bytes; }

bool is_signed_integer(ElementaryType type) noexcept {
  return type >= ElementaryType::sint && type <= ElementaryType::lint;
}

bool is_integer(ElementaryType type) noexcept {
  return type >= ElementaryType::sint && type <= ElementaryType::ulint;
}

bool is_real(ElementaryType type) noexcept {
  return type == ElementaryType::real || type == ElementaryType::lreal;
}

bool is_number(ElementaryType type) noexcept { return is_integer(type) || is_real(type); }

bool is_bits(ElementaryType type) noexcept {
  return type == ElementaryType::boolean || (type >= ElementaryType::byte && type <= ElementaryType::lword);
}

std::uint64_t wrapped(ElementaryType type, std::uint64_t bits) noexcept {
  switch (type) {
    case ElementaryType::boolean:
      return bits & 1U;
    case ElementaryType::sint:
      return sign_extended<std::int8_t>(bits);
    case ElementaryType::int_:
      return sign_extended<std::int16_t>(bits);
    case ElementaryType::dint:
      return sign_extended<std::int32_t>(bits);
    case ElementaryType::usint:
    case ElementaryType::byte:
      return static_cast<std::uint8_t>(bits);
    case ElementaryType::uint:
    case ElementaryType::word:
      return static_cast<std::uint16_t>(bits);
    case ElementaryType::udint:
    case ElementaryType::dword:
    case ElementaryType::real:
      return static_cast<std::uint32_t>(bits);
    case ElementaryType::lint:
    case ElementaryType::ulint:
    case ElementaryType::lword:
    case ElementaryType::lreal:
    case ElementaryType::time:
      return bits;
  }
  return bits;
}

std::uint64_t load(ElementaryType type, const std::byte* from) noexcept {
  std::uint64_t bits = 0;
  std::memcpy(&bits, from, size_bytes(type));
  return wrapped(type, bits);
}

void store(ElementaryType type, std::byte* to, std::uint64_t bits) noexcept {
  std::memcpy(to, &bits, size_bytes(type));
}

}  // namespace emulator_models::soft_plc
