// How "ltsim explore -- ./program argument" comes to run in the program's own process: the tool puts the command into the environment
// and becomes the program, whose start (start.cpp) finds it there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ltsim {

/// As which scenario a program is known: its file's name; of ltsim-processes, the names of its processes.
/// @param program  its path, and its arguments, which are in order
[[nodiscard]] std::string scenario_name_of(const std::vector<std::string>& program);

/// Becomes the program. @param command  e.g. {"ltsim", "explore", "--seed", "2", "bank"}: the program by its scenario's name
/// @param program  its path, and its arguments; ltsim-processes is known without a folder
/// @return  only if that cannot be: why
[[nodiscard]] std::string launch_program(const std::vector<std::string>& command,
                                         const std::vector<std::string>& program);

/// A program itself, or the one that loads others as processes.
enum class LaunchedProgram : std::uint8_t { whole, processes };

/// In the program: the command that it was launched with, which is taken out of the environment; nothing if it was called as any
/// program is.
[[nodiscard]] std::optional<std::vector<std::string>> take_launch_command(LaunchedProgram program);

}  // namespace ltsim
