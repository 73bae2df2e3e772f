// Two rungs of one scan read an input that changes in between: the brake and the motor are both on
// (openplc-runtime PR #74, #138, #142).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Image {
  std::atomic<std::uint32_t> start_button, motor, brake;
};

}  // namespace

SHAPE(
    "races/o22-input-in-mid-scan",
    {.finding = "I23", .depth = 2, .tasks_count = 2, .cure = "the scan works on a copy made when it begins"},
    "an input changes between two rungs of a scan") {
  races::name_words(world, "image", {"start-button", "motor", "brake"});

  world.process("io").start("main", [] {
    const races::Shared<Image> image{"image"};
    image->start_button = 1;
  });
  world.process("plc").start("scan", [&] {
    const races::Shared<Image> image{"image"};
    for (int scan = 0; scan < 2; ++scan) {
      const std::uint32_t latched = image->start_button;
      const auto start_button = [&] { return corrected ? latched : image->start_button.load(); };
      const bool motor = start_button() != 0;
      image->motor = motor ? 1 : 0;
      const bool brake = start_button() == 0;
      image->brake = brake ? 1 : 0;
      world.require(motor != brake, "I23: two rungs of one scan see an input differently");
    }
  });
  world.run();
}
