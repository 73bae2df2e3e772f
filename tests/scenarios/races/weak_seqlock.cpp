// Two words that belong together, written by one process and copied by another without a lock: a sequence number is odd
// while they are written, and a copy counts if the number was the same even one before and after. One shape for each
// memory order without which a copy of two different values counts (Boehm, "Can seqlocks get along with programming
// language memory models?", MSPC 2012).
//
// Depth: nothing makes the reader wait, so his place counts, too. He begins after a write has ended, one order, or the
// writer overtakes him between the two words, two orders; that he sees an older store is one more.

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Position {
  std::atomic<std::uint32_t> sequence, x, y;
};

/// All that are needed are here: the store of the odd number, the second load of the number and the accesses to the words
/// are relaxed in the right program, too, because the fences order them.
struct SeqlockOrders {
  // Who loads one of the words below and then passes the read fence sees the odd number, or a newer one.
  std::memory_order write_fence = std::memory_order_release;
  std::memory_order even_store = std::memory_order_release;  // who sees it sees both words of it
  std::memory_order first_load = std::memory_order_acquire;  // the words are at least as new as the number
  std::memory_order read_fence = std::memory_order_acquire;  // pairs with the write fence
};

template <SeqlockOrders orders>
void write(Position& position) {
  constexpr std::uint32_t writes_count = 2;
  for (std::uint32_t value = 1; value <= writes_count; ++value) {
    position.sequence.store(2 * value - 1, std::memory_order_relaxed);
    std::atomic_thread_fence(orders.write_fence);
    position.x.store(value, std::memory_order_relaxed);
    position.y.store(value, std::memory_order_relaxed);
    position.sequence.store(2 * value, orders.even_store);
  }
}

template <SeqlockOrders orders>
void read(Position& position, ltsim::World& world) {
  constexpr int tries_count = 3;
  for (int i = 0; i < tries_count; ++i) {
    const std::uint32_t sequence = position.sequence.load(orders.first_load);
    const std::uint32_t x = position.x.load(std::memory_order_relaxed);
    const std::uint32_t y = position.y.load(std::memory_order_relaxed);
    std::atomic_thread_fence(orders.read_fence);
    const bool counts = sequence % 2 == 0 && position.sequence.load(std::memory_order_relaxed) == sequence;
    if (counts) world.require(x == y, "I4: the x of one position with the y of another");
  }
}

template <SeqlockOrders orders>
void run_seqlock(ltsim::World& world) {
  races::name_words(world, "position", {"sequence", "x", "y"});
  world.process("emulator").start("writer", [] { write<orders>(*races::Shared<Position>{"position"}); });
  world.process("kernel").start("reader",
                                [&world] { read<orders>(*races::Shared<Position>{"position"}, world); });
  world.run();
}

constexpr SeqlockOrders right;

}  // namespace

SHAPE("races/weak-seqlock-write-fence",
      {.finding = "I4",
       .depth = 3,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "a release fence between the odd number and the words"},
      "a sequence lock whose writer has no fence after the odd number (memory c11)") {
  corrected ? run_seqlock<right>(world) : run_seqlock<{.write_fence = std::memory_order_relaxed}>(world);
}

SHAPE("races/weak-seqlock-even-store",
      {.finding = "I4",
       .depth = 2,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "the even number is stored with release"},
      "a sequence lock whose writer ends with a relaxed store (memory c11)") {
  corrected ? run_seqlock<right>(world) : run_seqlock<{.even_store = std::memory_order_relaxed}>(world);
}

SHAPE("races/weak-seqlock-first-load",
      {.finding = "I4",
       .depth = 2,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "the number is loaded with acquire before the words"},
      "a sequence lock whose reader begins with a relaxed load (memory c11)") {
  corrected ? run_seqlock<right>(world) : run_seqlock<{.first_load = std::memory_order_relaxed}>(world);
}

SHAPE("races/weak-seqlock-read-fence",
      {.finding = "I4",
       .depth = 3,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "an acquire fence between the words and the second load of the number"},
      "a sequence lock whose reader has no fence before it looks again (memory c11)") {
  corrected ? run_seqlock<right>(world) : run_seqlock<{.read_fence = std::memory_order_relaxed}>(world);
}
