// How wide must a sequence number be? One slot; the kernel gives up a request after its time-out and sends the next
// one, with the next number modulo N; answers with another number are dropped. An answer that is N time-outs late
// has the right number again. The deeper the larger N: each time-out is a constraint of its own.

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

/// Sequence number in the high half, number of the request in the low one: a message is one store.
struct Slot {
  std::atomic<std::uint32_t> request, answer;
};

constexpr std::uint32_t message(std::uint32_t sequence, std::uint32_t number) {
  return sequence << 16U | number;
}

/// @param modulus  of the sequence numbers, unless they are whole
void run_exchange(ltsim::World& world, std::uint32_t modulus, bool whole_numbers) {
  const std::uint32_t requests_count = modulus + 2;
  races::name_words(world, "handoff", {"request", "answer"});

  world.process("kernel").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell answer_bell{"answer"};
    for (std::uint32_t number = 0; number < requests_count; ++number) {
      const std::uint32_t sequence = whole_numbers ? number : number % modulus;
      slot->request = message(sequence, number);
      request_bell.ring();
      while (answer_bell.wait_for(races::Milliseconds{10})) {
        const std::uint32_t answer = slot->answer;
        if (answer >> 16U != sequence) continue;  // a late one: dropped
        world.require(answer == message(sequence, number),
                      "I1: the answer to an older request was delivered");
        break;
      }
    }
  });
  world.process("emulator").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell answer_bell{"answer"};
    for (std::uint32_t served = 0; served < requests_count; ++served) {
      request_bell.wait();
      const std::uint32_t request = slot->request;
      slot->answer = request;
      answer_bell.ring();
    }
  });
  world.run();
}

}  // namespace

SHAPE("races/stale-answer-modulo-1",
      {.finding = "I1",
       .depth = 2,
       .tasks_count = 2,
       .cure = "the whole number, of 16 bits, is the sequence number"},
      "an answer that is 1 time-out late has the right sequence number modulo 1") {
  run_exchange(world, 1, corrected);
}

SHAPE("races/stale-answer-modulo-2",
      {.finding = "I1",
       .depth = 3,
       .tasks_count = 2,
       .cure = "the whole number, of 16 bits, is the sequence number"},
      "an answer that is 2 time-outs late has the right sequence number modulo 2") {
  run_exchange(world, 2, corrected);
}

SHAPE("races/stale-answer-modulo-3",
      {.finding = "I1",
       .depth = 4,
       .tasks_count = 2,
       .cure = "the whole number, of 16 bits, is the sequence number"},
      "an answer that is 3 time-outs late has the right sequence number modulo 3") {
  run_exchange(world, 3, corrected);
}

SHAPE("races/stale-answer-modulo-4",
      {.finding = "I1",
       .depth = 5,
       .tasks_count = 2,
       .cure = "the whole number, of 16 bits, is the sequence number"},
      "an answer that is 4 time-outs late has the right sequence number modulo 4") {
  run_exchange(world, 4, corrected);
}

SHAPE("races/stale-answer-modulo-8",
      {.finding = "I1",
       .depth = 9,
       .tasks_count = 2,
       .cure = "the whole number, of 16 bits, is the sequence number"},
      "an answer that is 8 time-outs late has the right sequence number modulo 8") {
  run_exchange(world, 8, corrected);
}
