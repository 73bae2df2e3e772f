// What the names of a PLC's own storage mean to a program: addresses, devices, and blocks that are there without a
// declaration.
//
// The soft PLC has addresses only (il_address.hpp); a PLC of a maker gives the compiler a map of its own. An error
// is the reason and the way out, without the place, which the compiler knows.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/il_blocks.hpp"
#include "emulator_models/soft_plc/il_program.hpp"

namespace emulator_models::soft_plc {

/// A value that an instruction can name.
struct ValuePlace {
  ElementaryType type = ElementaryType::boolean;
  Area area = Area::variables;
  std::uint32_t offset = 0;
  std::uint8_t bit_index = 0;
  /// Why the program must not write it, "an input"; empty when it may.
  std::string_view read_only_as;
};

/// A block that the PLC has by itself, under this kind, with these parts of it in Area::memory.
struct PlcBlock {
  BlockKind kind = BlockKind::ton;
  BlockDevices devices;
};

class AddressMap {
 public:
  virtual ~AddressMap() = default;

  /// @param text  from the % on, as %IX0.0
  /// @return      its place, with the bit string of its size as type
  [[nodiscard]] virtual tl::expected<ValuePlace, std::string> address(std::string_view text) const = 0;
  /// What follows AT and is no % address.
  /// @param type  of the variable that is to lie there
  [[nodiscard]] virtual tl::expected<ValuePlace, std::string> device(std::string_view upper_name,
                                                                     ElementaryType type) const = 0;
  /// An operand that is not declared, as X5 in LD X5.
  /// @return nothing when it is the name of no device; the reason when it is, and the PLC has not this one
  [[nodiscard]] virtual std::optional<tl::expected<ValuePlace, std::string>> undeclared(
      std::string_view upper_name) const = 0;
  /// @return nothing when it is the name of no such block; the reason when it is, and the PLC has not this one
  [[nodiscard]] virtual std::optional<tl::expected<PlcBlock, std::string>> block(
      std::string_view upper_name) const = 0;

 protected:
  AddressMap() = default;
  AddressMap(const AddressMap&) = default;
  AddressMap& operator=(const AddressMap&) = default;
};

}  // namespace emulator_models::soft_plc
