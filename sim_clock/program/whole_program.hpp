// A whole program as a scenario: its main() is task "main" of one process, and each execution begins with the memory that the program
// had when main() was called first.
//
// What is put back: its variables, its heap, its thread-locals, what it has asked atexit(3) for, its descriptors (open_descriptors.hpp).
// Not put back is what a library keeps for itself (a locale, a stream's state), and files. In a process forked for the execution
// (StartState::fork) there is nothing to be put back.
#pragma once

#include <string>
#include <vector>

namespace ltsim {

struct ProgramStart {
  int (*main)(int, char**, char**) = nullptr;
  std::vector<std::string> arguments;  ///< argv: its path first
  char** environment = nullptr;
};

/// Runs the command line of ltsim over the program alone.
/// @param command  e.g. {"ltsim", "explore", "--seed", "2", "bank"}: the program by its scenario's name
/// @return         the exit code
[[nodiscard]] int run_whole_program(const ProgramStart& program, const std::vector<std::string>& command);

}  // namespace ltsim
