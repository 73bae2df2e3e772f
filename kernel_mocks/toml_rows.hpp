// What the TOML readers of this folder share: a file that is one array of tables.
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string_view>

#include <toml++/toml.h>
#include <tl/expected.hpp>

#include "kernel_mocks/config_error.hpp"

namespace kernel_mocks {

[[nodiscard]] ConfigError error_at(const toml::node& node, std::string reason);

/// Refuses keys that are not in `known`.
[[nodiscard]] std::optional<ConfigError> check_keys(const toml::table& table,
                                                    std::initializer_list<std::string_view> known);

/// Calls `take` for every table of the array `name`, until one is refused.
[[nodiscard]] std::optional<ConfigError> for_each_row(
    std::string_view text, std::string_view name,
    const std::function<std::optional<ConfigError>(const toml::table& row)>& take);

}  // namespace kernel_mocks
