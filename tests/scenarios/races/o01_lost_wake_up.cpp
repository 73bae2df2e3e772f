// A doorbell used as an auto-reset event: the emulator sets its count back to 0 after each answer, and with it
// swallows the ring for the next request (LMAX Disruptor #119, the published handoff under one reading).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Slot {
  std::atomic<std::uint32_t> request, response;
};

}  // namespace

SHAPE(
    "races/o01-lost-wake-up",
    {.finding = "I9", .depth = 1, .tasks_count = 2, .cure = "only the wait takes a count from the semaphore"},
    "the emulator sets its semaphore back to 0 after an answer") {
  constexpr std::uint32_t requests_count = 2;
  races::name_words(world, "handoff", {"request", "response"});
  bool rung = false;  // and not yet heard

  world.process("kernel").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell response_bell{"response"};
    for (std::uint32_t number = 1; number <= requests_count; ++number) {
      slot->request = number;
      rung = true;
      request_bell.ring();
      response_bell.wait();
    }
  });
  world.process("emulator").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell response_bell{"response"};
    for (std::uint32_t served = 0; served < requests_count; ++served) {
      request_bell.wait();
      rung = false;
      slot->response = slot->request + 100;
      response_bell.ring();
      while (!corrected && request_bell.try_take()) {
      }
    }
  });
  world.whenever_idle([&] {
    world.require(!(rung && world.blocked_in("emulator/main") == "sem_wait request"),
                  "I9: a request is published and posted, and the emulator sleeps");
  });
  world.run();
}
