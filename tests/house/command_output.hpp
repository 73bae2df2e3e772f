// What a command prints.
#pragma once

#include <optional>
#include <string>

namespace house {

/// @param command  for the shell; its standard error is not shown
/// @return its standard output; nothing when it cannot be run or does not exit with 0
[[nodiscard]] std::optional<std::string> output_of(const std::string& command);

}  // namespace house
