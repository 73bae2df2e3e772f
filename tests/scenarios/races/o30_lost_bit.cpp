// Request and response flag share a word; each side sets its own by load and store, and one of them is lost (ext4
// ed8ad83808f0, CVE-2025-68358).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Flags {
  std::atomic<std::uint32_t> word;
};

void set(std::atomic<std::uint32_t>& word, std::uint32_t bit, bool at_once) {
  if (at_once) {
    word |= bit;
  } else {
    word = word | bit;
  }
}

}  // namespace

SHAPE("races/o30-lost-bit",
      {.finding = "I14", .depth = 2, .tasks_count = 2, .cure = "one atomic update of the word"},
      "two sides each set a bit of one word") {
  races::name_words(world, "flags", {"word"});
  std::uint32_t bits_set = 0;

  for (const std::uint32_t bit : {1U, 2U}) {
    world.process(bit == 1 ? "kernel" : "emulator").start("main", [&world, &bits_set, corrected, bit] {
      const races::Shared<Flags> flags{"flags"};
      set(flags->word, bit, corrected);
      bits_set |= bit;
      world.require((flags->word & bits_set) == bits_set, "I14: a flag that was set is gone");
    });
  }
  world.run();
}
