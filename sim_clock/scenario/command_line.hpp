// The command line that every scenario program has: list, explore, replay, minimize, zoo, fuzz.
//
// Exit codes: 0 nothing found, 1 a failure was found, 2 bad usage or an unreadable file, 3 our own fault.
#pragma once

namespace ltsim {

/// @return the exit code
int run_command_line(int argc, const char* const* argv);

}  // namespace ltsim
