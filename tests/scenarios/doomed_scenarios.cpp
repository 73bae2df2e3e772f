// Scenarios that end badly for the program that explores them: `doomed`, which the tests run as a user runs
// `ltsim`.

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

#include "sim_clock/scenario/fuzz_target.hpp"
#include "sim_clock/scenario/scenario.hpp"

namespace {

void some_steps(ltsim::World& world) {
  static std::atomic<int> counter;
  counter = 0;
  for (const char* name : {"one", "two"}) world.process("p").start(name, [] { counter = counter + 1; });
  world.run();
}

}  // namespace

SCENARIO("doomed/kills", "the process dies of SIGKILL in some executions, in others a property breaks") {
  const std::size_t answer = world.choose("what", 50);
  if (answer == 7) kill(getpid(), SIGKILL);
  some_steps(world);
  world.require(answer != 8, "eight, and <\"&'> \x01\xff");
}

SCENARIO("doomed/hangs", "a task waits for itself, without a scheduling point") {
  const bool hangs = world.choose("hang", 20) == 7;
  world.process("p").start("main", [hangs] {
    for (volatile bool go_on = hangs; go_on;) {
    }
  });
  world.run();
}

SCENARIO("doomed/interrupts", "somebody loses patience after 300 executions; a property breaks before that") {
  static int executions = 0;
  if (++executions == 300) kill(getppid(), SIGINT);
  const std::size_t answer = world.choose("what", 20);
  some_steps(world);
  world.require(answer != 8, "eight");
}

SCENARIO("doomed/terminates", "the machine is shut down after 300 executions, in which all went well") {
  static int executions = 0;
  if (++executions == 300) kill(getppid(), SIGTERM);
  some_steps(world);
}

SCENARIO("doomed/calls-fork", "what is not simulated is called after a property has been broken") {
  const std::size_t answer = world.choose("what", 200);
  world.process("p").start("main", [answer] {
    if (answer == 7) static_cast<void>(fork());
  });
  world.run();
  world.require(answer % 2 != 0, "even");
}

FUZZ_TARGET("doomed-words", {}, "lines of text, of which two must not meet") {
  const std::string_view text{reinterpret_cast<const char*>(input.data()), input.size()};
  const bool meet =
      text.find("fire") != std::string_view::npos && text.find("powder") != std::string_view::npos;
  ltsim::expect(!meet, "fire and powder are kept apart");
}
