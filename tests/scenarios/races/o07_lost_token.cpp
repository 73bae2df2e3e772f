// The emulator is killed after its semaphore has let it pass and before it has answered. It is started again and waits;
// the count is gone, and nobody knows (the semaphore's variant of an orphaned lock).

#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

enum State : std::uint32_t { idle, requested, answered };

struct Slot {
  std::atomic<std::uint32_t> state, request, response, stop;
};

}  // namespace

SHAPE("races/o07-lost-token",
      {.finding = "I17",
       .depth = 2,
       .tasks_count = 2,
       .cure = "the emulator looks at the state before it waits"},
      "the emulator is killed between its wait and its answer") {
  races::name_words(world, "handoff", {"state", "request", "response", "stop"});
  bool requested_and_not_answered = false;
  world.process("emulator").may_crash({.times = 1, .restart_after = races::Milliseconds{5}});

  world.process("kernel").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell doorbell{"doorbell"};
    slot->request = 1;
    slot->state = requested;
    requested_and_not_answered = true;
    doorbell.ring();
    while (slot->state != answered) std::this_thread::sleep_for(races::Milliseconds{1});
    slot->stop = 1;
    doorbell.ring();
  });
  world.process("emulator").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell doorbell{"doorbell"};
    while (slot->stop == 0) {
      if (!corrected || slot->state != requested) doorbell.wait();
      if (slot->state != requested) continue;
      slot->response = slot->request + 100;
      slot->state = answered;
      requested_and_not_answered = false;
    }
  });
  world.whenever_idle([&] {
    world.require(!(requested_and_not_answered && world.blocked_in("emulator/main") == "sem_wait doorbell"),
                  "I17: a request is published, and the emulator that was started again sleeps");
  });
  world.run();
}
