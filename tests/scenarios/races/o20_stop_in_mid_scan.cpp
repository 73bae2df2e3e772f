// The logic of a scan reads the mode, and so does its output phase; the key switch is turned in between
// (openplc-runtime PR #162, PR #120).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

enum Mode : std::uint32_t { stop, run };

struct Plc {
  std::atomic<std::uint32_t> mode, output;
};

}  // namespace

SHAPE("races/o20-stop-in-mid-scan",
      {.finding = "I25", .depth = 2, .tasks_count = 2, .cure = "the mode is read once, when the scan begins"},
      "one scan runs its logic in RUN and its outputs in STOP") {
  races::name_words(world, "plc", {"mode", "output"});

  world.process("panel").start("key-switch", [] {
    const races::Shared<Plc> plc{"plc"};
    plc->mode = run;
    plc->mode = stop;
  });
  world.process("plc").start("scan", [&] {
    const races::Shared<Plc> plc{"plc"};
    for (int scan = 0; scan < 2; ++scan) {
      const std::uint32_t mode_of_logic = plc->mode;
      const std::uint32_t result = mode_of_logic == run ? 1 : 0;
      const std::uint32_t mode_of_outputs = corrected ? mode_of_logic : plc->mode.load();
      plc->output = mode_of_outputs == run ? result : 0;
      world.require(mode_of_logic == mode_of_outputs, "I25: one scan runs in two modes");
    }
  });
  world.run();
}
