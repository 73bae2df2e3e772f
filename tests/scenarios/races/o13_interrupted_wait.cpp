// A wait on a semaphore that a signal interrupts comes back without a count, and nobody looks at what it returned: the
// request that is then executed is none (vtrunkd PR #240, TDengine PR #3251).

#include <fcntl.h>
#include <semaphore.h>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

enum State : std::uint32_t { idle, requested, answered };

struct Slot {
  std::atomic<std::uint32_t> state, request;
};

}  // namespace

SHAPE("races/o13-interrupted-wait",
      {.finding = "I3",
       .depth = 1,
       .tasks_count = 2,
       .cure = "after each wake the state decides, and nothing else"},
      "an interrupted wait is taken for a request") {
  races::name_words(world, "handoff", {"state", "request"});
  world.grant(ltsim::FaultKind::interrupt, 1);

  world.process("kernel").start("main", [] {
    const races::Shared<Slot> slot{"handoff"};
    sem_t* const doorbell = sem_open("/doorbell", O_CREAT, 0600, 0);
    slot->request = 1;
    slot->state = requested;
    sem_post(doorbell);
  });
  world.process("emulator").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    sem_t* const doorbell = sem_open("/doorbell", O_CREAT, 0600, 0);
    do {
      sem_wait(doorbell);
    } while (corrected && slot->state != requested);
    const std::uint32_t request = slot->request;
    world.require(request == 1, "I3: a request is executed that nobody has sent");
    slot->state = answered;
  });
  world.run();
}
