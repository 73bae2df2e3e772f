// Reads an operator's script from TOML: [[event]] tables with `at_ms` or `block`, and `press`.
#pragma once

#include <string_view>

#include <tl/expected.hpp>

#include "kernel_mocks/config_error.hpp"
#include "kernel_mocks/operator_panel.hpp"

namespace kernel_mocks {

[[nodiscard]] tl::expected<OperatorScript, ConfigError> parse_operator_script(std::string_view text);

}  // namespace kernel_mocks
