// A request that timed out before it was taken leaves its count in the doorbell; the next request is then rung for
// twice and executed twice (nasa/fprime PR #5634, cloudtoid/interprocess #37).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

enum State : std::uint32_t { idle, requested, busy, answered };

struct Slot {
  std::atomic<std::uint32_t> state, request;
};

bool change(std::atomic<std::uint32_t>& state, std::uint32_t from, std::uint32_t to) {
  return state.compare_exchange_strong(from, to);
}

}  // namespace

SHAPE("races/o06-semaphore-drift",
      {.finding = "I5",
       .depth = 1,
       .tasks_count = 2,
       .cure = "both sides must win the slot by a compare-and-exchange before they use it"},
      "a time-out leaves a count in the doorbell") {
  constexpr std::uint32_t requests_count = 2;
  races::name_words(world, "handoff", {"state", "request"});

  world.process("kernel").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell response_bell{"response"};
    for (std::uint32_t number = 1; number <= requests_count; ++number) {
      slot->request = number;
      slot->state = requested;
      request_bell.ring();
      if (response_bell.wait_for(races::Milliseconds{10})) continue;
      // Given up. In the corrected program only what the emulator has not taken can be.
      if (corrected && !change(slot->state, requested, idle)) response_bell.wait();
    }
  });
  world.process("emulator").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell response_bell{"response"};
    std::uint32_t last_executed = 0;
    for (std::uint32_t heard = 0; heard < requests_count; ++heard) {
      request_bell.wait();
      if (corrected && !change(slot->state, requested, busy)) continue;
      const std::uint32_t number = slot->request;
      world.require(number != last_executed, "I5: a request was executed twice");
      last_executed = number;
      slot->state = answered;
      response_bell.ring();
    }
  });
  world.run();
}
