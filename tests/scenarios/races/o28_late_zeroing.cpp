// The kernel starts first and rings; the emulator then clears the segment, finds no request, and waits for a ring that
// it has already heard (LinuxCNC PR #3292, #2700).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

enum State : std::uint32_t { idle, requested, answered };

struct Slot {
  std::atomic<std::uint32_t> state, request;
};

}  // namespace

SHAPE("races/o28-late-zeroing",
      {.finding = "I9",
       .depth = 1,
       .tasks_count = 2,
       .cure = "nobody clears a segment that is in use; a new one is all zeros"},
      "the emulator clears a segment that already holds a request") {
  races::name_words(world, "handoff", {"state", "request"});
  bool rung = false;  // and not yet taken

  world.process("kernel").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell response_bell{"response"};
    slot->request = 1;
    slot->state = requested;
    rung = true;
    request_bell.ring();
    response_bell.wait();
  });
  world.process("emulator").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell response_bell{"response"};
    if (!corrected) {
      slot->state = idle;
      slot->request = 0;
    }
    do {
      request_bell.wait();
    } while (slot->state != requested);
    rung = false;
    slot->state = answered;
    response_bell.ring();
  });
  world.whenever_idle([&] {
    world.require(!(rung && world.blocked_in("emulator/main") == "sem_wait request"),
                  "I9: a request is published and posted, and the emulator sleeps");
  });
  world.run();
}
