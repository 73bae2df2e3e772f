// The writer stores bytes and then a flag, the reader waits for the flag and then loads the bytes, and nothing tells the
// compiler or the machine that these orders matter (kvmtool 15c4e1ef906e, PostgreSQL 4c853646, LinuxCNC #3222).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Area {
  std::atomic<std::uint32_t> bytes, flag;
};

}  // namespace

SHAPE("races/o11-store-store-reordering",
      {.finding = "I13",
       .depth = 1,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "the flag is stored with release and loaded with acquire"},
      "a flag is seen before the bytes that it stands for (memory c11)") {
  constexpr std::uint32_t written = 7;
  const auto store_order = corrected ? std::memory_order_release : std::memory_order_relaxed;
  const auto load_order = corrected ? std::memory_order_acquire : std::memory_order_relaxed;
  races::name_words(world, "area", {"bytes", "flag"});

  world.process("kernel").start("main", [&] {
    const races::Shared<Area> area{"area"};
    area->bytes.store(written, std::memory_order_relaxed);
    area->flag.store(1, store_order);
  });
  world.process("emulator").start("main", [&] {
    const races::Shared<Area> area{"area"};
    if (!races::poll_until([&] { return area->flag.load(load_order) != 0; })) return;
    world.require(area->bytes.load(std::memory_order_relaxed) == written,
                  "I13: the flag was there, and not the bytes");
  });
  world.run();
}
