// The input that a schedule file holds.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fuzz {

/// @param text  of a file
/// @return      its "input" lines as the bytes they stand for; nothing if it is no schedule
[[nodiscard]] std::optional<std::string> input_of(std::string_view text);

}  // namespace fuzz
