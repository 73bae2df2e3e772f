// Several whole programs as the processes of one world: each is an image with variables of its own, loaded into the same real process.
//
// Services begin first. The processes begin when each service waits for SIGTERM, which is how a program says that it is ready; and
// when all processes have ended, the services get it. An image that is killed may begin again, with its variables as they were.
#pragma once

#include <string>
#include <vector>

namespace ltsim {

/// Loads the images and runs the command line of ltsim over the world of them.
/// @param arguments    of ltsim-processes, without its path: see WorldOptions
/// @param environment  of each main()
/// @param command      e.g. {"ltsim", "explore", "--seed", "2", "kernel+emulator"}
/// @return             the exit code
[[nodiscard]] int run_processes(const std::vector<std::string>& arguments, char** environment,
                                const std::vector<std::string>& command);

}  // namespace ltsim
