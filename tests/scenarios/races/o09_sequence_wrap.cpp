// Each request is worked on by a thread of its own; answers carry a sequence number of one bit. The late answer to
// request 0 is taken for that to request 2 (Nethermind PR #10717, iceoryx #2351, Therac-25).

#include <array>
#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

constexpr std::uint32_t requests_count = 3;

/// Sequence number in the high half, value in the low one: an answer is one store.
struct Slot {
  std::atomic<std::uint32_t> request, answer;
};

constexpr std::uint32_t answer_of(std::uint32_t sequence, std::uint32_t value) {
  return sequence << 16U | value;
}

}  // namespace

SHAPE("races/o09-sequence-wrap",
      {.finding = "I1",
       .depth = 2,
       .tasks_count = 3,
       .cure = "more sequence numbers than requests that can be under way"},
      "a sequence number of one bit comes round again") {
  const std::uint32_t sequence_mask = corrected ? 0xffff : 1;
  races::name_words(world, "handoff", {"request", "answer"});

  world.process("kernel").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell answer_bell{"answer"};
    for (std::uint32_t number = 0; number < requests_count; ++number) {
      slot->request = number;
      request_bell.ring();
      while (answer_bell.wait_for(races::Milliseconds{10})) {
        const std::uint32_t answer = slot->answer;
        if (answer >> 16U != (number & sequence_mask)) continue;  // a late one: dropped
        world.require((answer & 0xffffU) == number, "I1: an older answer was delivered");
        break;
      }
    }
  });
  world.process("emulator").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell answer_bell{"answer"};
    std::array<std::thread, requests_count> workers;
    for (std::thread& worker : workers) {
      request_bell.wait();
      const std::uint32_t number = slot->request;
      worker = std::thread{[&, number] {
        slot->answer = answer_of(number & sequence_mask, number);
        answer_bell.ring();
      }};
    }
    for (std::thread& worker : workers) worker.join();
  });
  world.run();
}
