// The PLC program of the propulsion station, propulsion.il, as it was when the library was built.
#pragma once

#include <string_view>

namespace emulator_models {

/// In instruction list; compiles without a mistake.
[[nodiscard]] std::string_view propulsion_program() noexcept;

}  // namespace emulator_models
