// Two kernels use one slot: each may be given the answer to the other's request (thingsboard-gateway #905,
// Growatt_ModbusTCP #351).

#include <mutex>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Slot {
  std::atomic<std::uint32_t> request, response;
};

constexpr std::uint32_t answer_to(std::uint32_t request) { return request * 100; }

}  // namespace

SHAPE("races/o29-two-masters",
      {.finding = "I1", .depth = 1, .tasks_count = 3, .cure = "the role of the master is taken exclusively"},
      "two masters exchange requests with one slave") {
  races::name_words(world, "handoff", {"request", "response"});

  for (const std::uint32_t request : {1U, 2U}) {
    world.process("kernel-" + std::to_string(request)).start("main", [&world, corrected, request] {
      const races::Shared<Slot> slot{"handoff"};
      races::Doorbell request_bell{"request"};
      races::Doorbell response_bell{"response"};
      races::NamedLock master{"master"};
      std::unique_lock role{master, std::defer_lock};
      if (corrected) role.lock();
      slot->request = request;
      request_bell.ring();
      response_bell.wait();
      world.require(slot->response == answer_to(request),
                    "I1: the answer to another master's request was delivered");
    });
  }
  world.process("emulator").start("main", [] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell response_bell{"response"};
    for (int served = 0; served < 2; ++served) {
      request_bell.wait();
      slot->response = answer_to(slot->request);
      response_bell.ring();
    }
  });
  world.run();
}
