// The scan has tested that nobody has stopped it; the watchdog stops the machine and writes the safe output; the scan
// writes its own (LinuxCNC #865, PR #882; g2 #177).

#include <mutex>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Outputs {
  std::atomic<std::uint32_t> stopped, speed;
};

}  // namespace

SHAPE("races/o21-output-after-stop",
      {.finding = "I19",
       .depth = 2,
       .tasks_count = 2,
       .cure = "a lock around the test and the output, and around the stop"},
      "an output is written after the machine was stopped") {
  races::name_words(world, "outputs", {"stopped", "speed"});
  bool is_stopped = false;

  world.process("plc").start("scan", [&] {
    const races::Shared<Outputs> outputs{"outputs"};
    races::NamedLock gate{"gate"};
    for (std::uint32_t speed = 1000; speed <= 2000; speed += 1000) {
      std::unique_lock guard{gate, std::defer_lock};
      if (corrected) guard.lock();
      if (outputs->stopped != 0) return;
      outputs->speed = speed;
      world.require(!is_stopped, "I19: an output changes after the stop");
    }
  });
  world.process("plc").start("watchdog", [&] {
    const races::Shared<Outputs> outputs{"outputs"};
    races::NamedLock gate{"gate"};
    std::unique_lock guard{gate, std::defer_lock};
    if (corrected) guard.lock();
    outputs->stopped = 1;
    outputs->speed = 0;
    is_stopped = true;
  });
  world.run();
}
