// The kernel gives up a request, sends the next one and takes the late answer to the first for the answer to the
// second (python-snap7 #70, NModbus #88, Linux arm_scmi "Check mailbox/SMT channel for consistency").

#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

enum State : std::uint32_t { idle, requested, answered };

struct Slot {
  std::atomic<std::uint32_t> state, request, response, answered_request;
};

constexpr std::uint32_t answer_to(std::uint32_t request) { return request * 100; }

/// @return whether the answer came in time
bool wait_for_answer(Slot& slot, std::uint32_t number, bool check_number) {
  const auto deadline = std::chrono::steady_clock::now() + races::Milliseconds{10};
  while (slot.state != answered || (check_number && slot.answered_request != number)) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(races::Milliseconds{1});
  }
  return true;
}

}  // namespace

SHAPE("races/o02-stale-response",
      {.finding = "I1",
       .depth = 2,
       .tasks_count = 2,
       .cure = "an answer carries the number of its request; another's is dropped and waiting goes on"},
      "a late answer is read as the answer to the request after it") {
  constexpr std::uint32_t requests_count = 2;
  races::name_words(world, "handoff", {"state", "request", "response", "answered-request"});

  world.process("kernel").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell doorbell{"doorbell"};
    for (std::uint32_t number = 1; number <= requests_count; ++number) {
      slot->request = number;
      slot->state = requested;
      doorbell.ring();
      if (!wait_for_answer(*slot, number, corrected)) continue;
      world.require(slot->response == answer_to(number), "I1: an older answer was delivered");
    }
  });
  world.process("emulator").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell doorbell{"doorbell"};
    for (std::uint32_t served = 0; served < requests_count; ++served) {
      doorbell.wait();
      const std::uint32_t number = slot->request;
      slot->response = answer_to(number);
      slot->answered_request = number;
      slot->state = answered;
    }
  });
  world.run();
}
