// A ring of 100 entries without a test for "full": an entry is overwritten only when the writer gets 100 entries ahead
// of the reader, so only a search that lets one task run far, and not the other, finds it.

#include <array>
#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

constexpr std::uint32_t ring_entries = 100;
constexpr std::uint32_t entries_count = 120;

/// Entries are numbered from 1; 0 is none.
struct Ring {
  std::atomic<std::uint32_t> written, taken;
  std::array<std::atomic<std::uint32_t>, ring_entries> entries;
};

}  // namespace

SHAPE("races/hundred-steps-apart",
      {.finding = "I3", .depth = 1, .tasks_count = 2, .cure = "the writer waits while the ring is full"},
      "the writer of a ring gets 100 entries ahead of the reader") {
  races::name_words(world, "ring", {"written", "taken"});

  world.process("kernel").start("writer", [&] {
    const races::Shared<Ring> ring{"ring"};
    for (std::uint32_t number = 1; number <= entries_count; ++number) {
      while (corrected && number - ring->taken > ring_entries) std::this_thread::yield();
      ring->entries[number % ring_entries] = number;
      ring->written = number;
    }
  });
  world.process("plc").start("reader", [&] {
    const races::Shared<Ring> ring{"ring"};
    for (std::uint32_t number = 1; number <= entries_count; ++number) {
      while (ring->written < number) std::this_thread::yield();
      world.require(ring->entries[number % ring_entries] == number,
                    "I3: an entry was overwritten before it was read");
      ring->taken = number;
    }
  });
  world.run();
}
