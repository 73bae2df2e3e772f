// What the targets of the kernel's TOML files have in common.
#pragma once

#include <string_view>

#include "fuzz/text_input.hpp"
#include "kernel_mocks/config_error.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace fuzz {

inline void check_refusal(std::string_view text, const kernel_mocks::ConfigError& error) {
  ltsim::expect(!error.reason.empty(), "a refusal has a reason");
  // A fault of the whole file has no place.
  ltsim::expect((error.line == 0 && error.column == 0) || is_inside(text, error.line, error.column),
                "a refusal names a place of the text");
}

}  // namespace fuzz
