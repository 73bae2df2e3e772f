// A count of milliseconds of 32 bits, and a deadline compared as if it never wrapped: 49.7 days after the start a
// time-out comes at once (picotcp #2, Battery-Emulator PR #2707, ZuluSCSI #328).

#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Slot {
  std::atomic<std::uint32_t> answered;
};

/// Milliseconds since the machine was switched on: here, 10 ms less than a count of 32 bits holds.
std::uint32_t millis() {
  constexpr std::uint32_t at_the_beginning = 0U - 10U;
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return at_the_beginning +
         static_cast<std::uint32_t>(std::chrono::duration_cast<races::Milliseconds>(now).count());
}

}  // namespace

SHAPE("races/o15-millisecond-wrap",
      {.finding = "I16", .depth = 1, .tasks_count = 2, .cure = "the difference is taken as a signed number"},
      "a deadline behind the wrap of a 32-bit clock") {
  constexpr std::uint32_t timeout_ms = 20;
  races::name_words(world, "handoff", {"answered"});

  world.process("emulator").start("main", [] {
    const races::Shared<Slot> slot{"handoff"};
    slot->answered = 1;
  });
  world.process("kernel").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    const ltsim::SimTime begin = world.now();
    const std::uint32_t deadline = millis() + timeout_ms;
    const auto expired = [&] {
      const std::uint32_t now = millis();
      return corrected ? static_cast<std::int32_t>(now - deadline) >= 0 : now >= deadline;
    };
    while (slot->answered == 0) {
      if (expired()) {
        // A count of whole milliseconds may be one too far.
        world.require(world.now() - begin >= races::Milliseconds{timeout_ms - 1},
                      "I16: a time-out is reported before its time");
        return;
      }
      std::this_thread::sleep_for(races::Milliseconds{1});
    }
  });
  world.run();
}
