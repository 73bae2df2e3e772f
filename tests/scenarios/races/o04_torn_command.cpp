// The reader tests that head and tail agree, then copies; what it copies is being rewritten by then. Two counters
// compared at one instant do not protect the copy that follows (LinuxCNC #2386, PR #2424, PR #2436).

#include <mutex>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Command {
  std::atomic<std::uint32_t> head, number, position, tail;
};

constexpr std::uint32_t position_of(std::uint32_t number) { return number * 1000; }

}  // namespace

SHAPE("races/o04-torn-command",
      {.finding = "I3",
       .depth = 2,
       .tasks_count = 2,
       .cure = "a lock around the writing and around the test and the copy"},
      "a command is copied while the next one is written over it") {
  races::name_words(world, "command", {"head", "number", "position", "tail"});

  world.process("task").start("main", [&] {
    const races::Shared<Command> command{"command"};
    races::NamedLock lock{"command-lock"};
    for (std::uint32_t number = 1; number <= 2; ++number) {
      std::unique_lock guard{lock, std::defer_lock};
      if (corrected) guard.lock();
      ++command->head;
      command->number = number;
      command->position = position_of(number);
      command->tail = command->head.load();
    }
  });
  world.process("motion").start("servo-thread", [&] {
    const races::Shared<Command> command{"command"};
    races::NamedLock lock{"command-lock"};
    for (int cycle = 0; cycle < 3; ++cycle) {
      std::unique_lock guard{lock, std::defer_lock};
      if (corrected) guard.lock();
      if (command->head != command->tail) continue;  // half written: next cycle
      const std::uint32_t number = command->number;
      const std::uint32_t position = command->position;
      world.require(position == position_of(number), "I3: one command's number, another's position");
    }
  });
  world.run();
}
