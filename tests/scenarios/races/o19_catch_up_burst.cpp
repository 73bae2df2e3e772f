// A scan that starts at each multiple of its period makes up for those it missed, in a burst (orocos rtt PR #129,
// ros2_control PR #2046).

#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Image {
  std::atomic<std::uint32_t> input, output;
};

}  // namespace

SHAPE("races/o19-catch-up-burst",
      {.finding = "I26", .depth = 1, .tasks_count = 2, .cure = "missed periods are counted and left out"},
      "scans that were missed are made up for at once") {
  using Clock = std::chrono::steady_clock;
  constexpr races::Milliseconds period{10};
  races::name_words(world, "image", {"input", "output"});

  world.process("plc").start("inputs", [] {
    const races::Shared<Image> image{"image"};
    for (std::uint32_t value = 1; value <= 4; ++value) {
      image->input = value;
      std::this_thread::sleep_for(races::Milliseconds{7});
    }
  });
  world.process("plc").start("scan", [&] {
    const races::Shared<Image> image{"image"};
    ltsim::SimTime last_start{-1'000'000'000};
    ltsim::SimTime start_before_last = last_start;
    Clock::time_point next = Clock::now() + period;
    for (int scan = 0; scan < 6; ++scan) {
      std::this_thread::sleep_until(next);
      world.require(world.now() - start_before_last >= period, "I26: three scans start within one period");
      start_before_last = last_start;
      last_start = world.now();
      image->output = image->input.load();
      next += period;
      const Clock::time_point now = Clock::now();
      if (corrected && next <= now) next += (now - next) / period * period + period;
    }
  });
  world.run();
}
