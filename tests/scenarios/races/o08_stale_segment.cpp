// The kernel is killed before it has taken an answer, and started again: the answer to its former life's request still
// lies in the segment, its bell is still rung (iceoryx2 #601, Linux mailbox PCC c2b69f71ffd0).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Slot {
  std::atomic<std::uint32_t> generation, request, response, answered_generation;
};

constexpr std::uint32_t answer_to(std::uint32_t request) { return request * 100; }

}  // namespace

SHAPE("races/o08-stale-segment",
      {.finding = "I1",
       .depth = 2,
       .tasks_count = 2,
       .cure = "each start of the kernel is a new generation, and an answer tells whose it is"},
      "a kernel that is started again finds the answer to its former life") {
  races::name_words(world, "handoff", {"generation", "request", "response", "answered-generation"});
  world.process("kernel").may_crash({.times = 1, .restart_after = races::Milliseconds{5}});

  world.process("kernel").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell response_bell{"response"};
    const std::uint32_t generation = ++slot->generation;
    slot->request = generation;
    request_bell.ring();
    do {
      if (!response_bell.wait_for(races::Milliseconds{20})) return;
    } while (corrected && slot->answered_generation != generation);
    world.require(slot->response == answer_to(generation), "I1: the answer to a former life was delivered");
  });
  world.process("emulator").start("main", [] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell response_bell{"response"};
    while (request_bell.wait_for(races::Milliseconds{100})) {
      const std::uint32_t request = slot->request;
      slot->response = answer_to(request);
      slot->answered_generation = request;
      response_bell.ring();
    }
  });
  world.run();
}
