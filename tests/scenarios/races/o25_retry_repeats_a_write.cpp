// The acknowledgement of a write is late, the master sends it again, and the slave executes it twice (grid-x/modbus
// #135, OctoPrint #2285).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Slot {
  std::atomic<std::uint32_t> request_number, stop;
};

}  // namespace

SHAPE("races/o25-retry-repeats-a-write",
      {.finding = "I5",
       .depth = 1,
       .tasks_count = 2,
       .cure = "requests are numbered, and a repeated one is only acknowledged again"},
      "a write is sent again after a time-out and executed twice") {
  races::name_words(world, "handoff", {"request-number", "stop"});
  int executed_count = 0;

  world.process("kernel").start("main", [] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell acknowledge_bell{"acknowledge"};
    slot->request_number = 1;
    for (int attempt = 0; attempt < 2; ++attempt) {
      request_bell.ring();
      if (acknowledge_bell.wait_for(races::Milliseconds{10})) break;
    }
    slot->stop = 1;
    request_bell.ring();
  });
  world.process("emulator").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell request_bell{"request"};
    races::Doorbell acknowledge_bell{"acknowledge"};
    std::uint32_t last_executed = 0;
    for (;;) {
      request_bell.wait();
      if (slot->stop != 0) return;
      const std::uint32_t number = slot->request_number;
      if (!corrected || number != last_executed)
        world.require(++executed_count == 1, "I5: a write was executed twice");
      last_executed = number;
      acknowledge_bell.ring();
    }
  });
  world.run();
}
