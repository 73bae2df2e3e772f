// The PLC program of the machine tool as text: machine_tool.il, embedded when the library is built.
#pragma once

#include <string_view>

namespace emulator_models {

extern const std::string_view machine_tool_source;

}  // namespace emulator_models
