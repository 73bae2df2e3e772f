// Reads a machine table from TOML: [[function]] tables as machine_table.toml shows them.
//
// A text with one fault is refused whole. Apart from the library of the kernel, which needs no TOML to run.
#pragma once

#include <string_view>

#include <tl/expected.hpp>

#include "kernel_mocks/config_error.hpp"
#include "kernel_mocks/machine_table.hpp"

namespace kernel_mocks {

[[nodiscard]] tl::expected<MachineTable, ConfigError> parse_machine_table(std::string_view text);

}  // namespace kernel_mocks
