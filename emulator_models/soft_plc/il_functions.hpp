// The standard functions of instruction list: their names and parameters.
//
// In the short form the CR is the first argument and the others follow the name; in the formal form each is
// named. LIMIT and SEL are made of simpler instructions by the compiler.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulator_models/soft_plc/il_types.hpp"

namespace emulator_models::soft_plc {

struct IlFunction {
  enum class Kind : std::uint8_t {
    convert,
    absolute,
    minimum,
    maximum,
    limit,
    select,
    shift_left,
    shift_right,
    rotate_left,
    rotate_right,
  };

  Kind kind = Kind::absolute;
  ElementaryType from = ElementaryType::boolean;  ///< of a conversion
  ElementaryType to = ElementaryType::boolean;
  std::vector<std::string_view> parameters;  ///< formal names in order
  bool extensible = false;                   ///< MIN and MAX: IN3, IN4 and so on may follow
};

/// @param upper_name  in capitals
[[nodiscard]] std::optional<IlFunction> find_function(std::string_view upper_name);

}  // namespace emulator_models::soft_plc
