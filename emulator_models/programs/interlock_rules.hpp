// The interlock rules that a PLC program is marked with: each of their lines ends in (* rule: NAME *).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace emulator_models {

/// @return the names that occur, each once, in order of first appearance
[[nodiscard]] std::vector<std::string> rules_of(std::string_view source);

/// @return the program without the lines of that rule; they are left empty, so that places stay the same
[[nodiscard]] std::string without_rule(std::string_view source, std::string_view name);

}  // namespace emulator_models
