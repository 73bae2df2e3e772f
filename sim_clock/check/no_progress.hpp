// Messages for executions that get nowhere: who waits for whom, and who polls what.
//
// Failures are told apart by their messages, so these hold what belongs to the failure (tasks, operations,
// objects, the tasks in the order of their numbers), and nothing of how far an execution had come.
#pragma once

#include <string>

namespace ltsim {

class World;

/// Nobody can run and no timer is armed: each waiting task, with who holds the mutex or has yet to end. Tasks
/// that wait for each other in a circle come first, told as a cycle.
[[nodiscard]] std::string describe_deadlock(const World& world);

/// Tasks took turns for long and did not end: each task that has not ended, with what it polls, repeats or
/// waits in.
[[nodiscard]] std::string describe_livelock(const World& world);

}  // namespace ltsim
