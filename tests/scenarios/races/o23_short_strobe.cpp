// The kernel holds an M strobe for a fixed time; a PLC whose scan takes longer just then never sees it (ISG manual
// P-CHAN-00041, LinuxCNC PR #4307).

#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Signals {
  std::atomic<std::uint32_t> strobe, fin, program_ended;
};

}  // namespace

SHAPE("races/o23-short-strobe",
      {.finding = "I27", .depth = 1, .tasks_count = 2, .cure = "the strobe is held until the PLC's FIN"},
      "an M strobe falls between two scans") {
  races::name_words(world, "signals", {"strobe", "fin", "program-ended"});
  int executed_count = 0;

  world.process("plc").start("scan", [&] {
    const races::Shared<Signals> signals{"signals"};
    bool was_on = false;
    while (signals->program_ended == 0) {
      const bool is_on = signals->strobe != 0;
      if (is_on && !was_on) ++executed_count;
      signals->fin = is_on ? 1 : 0;
      was_on = is_on;
      std::this_thread::sleep_for(races::Milliseconds{10});
    }
  });
  world.process("kernel").start("main", [&] {
    const races::Shared<Signals> signals{"signals"};
    signals->strobe = 1;
    if (corrected) {
      while (signals->fin == 0) std::this_thread::sleep_for(races::Milliseconds{1});
    } else {
      std::this_thread::sleep_for(races::Milliseconds{40});  // four scans
    }
    signals->strobe = 0;
    std::this_thread::sleep_for(races::Milliseconds{20});
    signals->program_ended = 1;
    world.require(executed_count == 1, "I27: an M code was strobed and not executed");
  });
  world.run();
}
