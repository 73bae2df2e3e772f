// The kernel publishes and rings only if the emulator says that it waits; the emulator says so and sleeps only if
// nothing is published. Each load may be carried out before the store ahead of it, on x86 too, and then nobody rings
// (kvmtool d7d79bd51412, DPDK 159793ac867b, liburing #541, where a first answer was that acquire is enough).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Slot {
  std::atomic<std::uint32_t> published, waiting;
};

/// Stores to one word, then loads the other.
/// @param fenced  of two sides that both are, at least one loads what the other has stored
/// @return        what the other has stored
std::uint32_t tell_and_look(std::atomic<std::uint32_t>& own, const std::atomic<std::uint32_t>& other,
                            bool fenced) {
  own.store(1, std::memory_order_release);
  if (fenced) std::atomic_thread_fence(std::memory_order_seq_cst);
  return other.load(std::memory_order_acquire);
}

}  // namespace

SHAPE("races/o10-store-load-reordering",
      {.finding = "I9",
       .depth = 1,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "a full fence on both sides, between the store and the load"},
      "the doorbell is left out for one who is about to sleep (memory c11)") {
  races::name_words(world, "handoff", {"published", "waiting"});
  bool is_published = false;

  world.process("kernel").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell doorbell{"doorbell"};
    is_published = true;
    if (tell_and_look(slot->published, slot->waiting, corrected) != 0) doorbell.ring();
  });
  world.process("emulator").start("main", [&] {
    const races::Shared<Slot> slot{"handoff"};
    races::Doorbell doorbell{"doorbell"};
    if (tell_and_look(slot->waiting, slot->published, corrected) == 0) doorbell.wait();
  });
  world.whenever_idle([&] {
    world.require(!(is_published && world.blocked_in("emulator/main") == "sem_wait doorbell"),
                  "I9: a request is published, nobody will ring, and the emulator sleeps");
  });
  world.run();
}
