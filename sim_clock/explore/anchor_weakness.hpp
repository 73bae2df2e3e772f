// How likely an anchor is to stand elsewhere after a rebuild.
//
// How often a task calls the system, or touches a named region by an atomic operation, is written in the code.
// How often it reads plain memory, or counts references, is the compiler's business; how often it looks at
// a clock, that of the time that all this takes.
#pragma once

#include <string_view>

namespace ltsim {

/// @param anchor  as in a schedule: "kernel/main before sem_wait handoff #2"
/// @return        0: as strong as can be; larger is weaker
[[nodiscard]] unsigned anchor_weakness(std::string_view anchor) noexcept;

}  // namespace ltsim
