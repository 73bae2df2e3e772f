// The PLC program of the machine tool, machine_tool.il, as it was when the library was built.
#pragma once

#include <string_view>

namespace emulator_models {

/// In instruction list; compiles without a mistake.
[[nodiscard]] std::string_view machine_tool_program() noexcept;

}  // namespace emulator_models
