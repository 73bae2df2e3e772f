// Two commands posted in a row to the one command slot of another process: the first is overwritten before it is
// read (LinuxCNC #2467: if the lost one is "leave e-stop", the machine cannot be started).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Slot {
  std::atomic<std::uint32_t> command;
};

}  // namespace

SHAPE("races/o03-overwritten-request",
      {.finding = "I5", .depth = 1, .tasks_count = 2, .cure = "the slot is written only while it is free"},
      "two commands in a row into one slot") {
  constexpr std::uint32_t commands_count = 2;
  races::name_words(world, "io-commands", {"command"});

  world.process("task").start("main", [&] {
    const races::Shared<Slot> slot{"io-commands"};
    races::Doorbell doorbell{"doorbell"};
    races::Doorbell slot_is_free{"slot-is-free", 1};
    for (std::uint32_t command = 1; command <= commands_count; ++command) {
      if (corrected) slot_is_free.wait();
      slot->command = command;
      doorbell.ring();
    }
  });
  world.process("io").start("main", [&] {
    const races::Shared<Slot> slot{"io-commands"};
    races::Doorbell doorbell{"doorbell"};
    races::Doorbell slot_is_free{"slot-is-free", 1};
    std::uint32_t last_executed = 0;
    for (std::uint32_t taken = 0; taken < commands_count; ++taken) {
      doorbell.wait();
      const std::uint32_t command = slot->command;
      if (corrected) slot_is_free.ring();
      world.require(command != last_executed, "I5: a command was executed twice, and another never");
      last_executed = command;
    }
  });
  world.run();
}
