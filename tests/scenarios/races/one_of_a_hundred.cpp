// A hundred stations report "ready" and "has a part" in two words; the monitor must look after the first station's
// first store and before anybody's second.

#include <atomic>
#include <cstdint>
#include <string>

#include "sim_clock/scenario/shape.hpp"
namespace {

constexpr unsigned stations_count = 100;

/// In the memory of one process: the stations are its threads.
struct Report {
  std::atomic<std::uint32_t> ready, has_part;
};

}  // namespace

SHAPE("races/one-of-a-hundred",
      {.finding = "I4",
       .depth = 2,
       .tasks_count = stations_count + 1,
       .cure = "a station tells that it has a part before it tells that it is ready"},
      "one of a hundred like threads must be between its two stores") {
  Report report{};
  for (unsigned station = 1; station <= stations_count; ++station) {
    world.process("line").start("station-" + std::to_string(station), [&] {
      if (!corrected) report.ready = 1;
      report.has_part = 1;
      if (corrected) report.ready = 1;
    });
  }
  world.process("line").start("monitor", [&] {
    const bool ready = report.ready != 0;
    const bool has_part = report.has_part != 0;
    world.require(!ready || has_part, "I4: a station is ready and has no part");
  });
  world.run();
}
