// The soft PLC as it is, and mutants of what stands around it: its clock, its program, its driver.

#include <chrono>

#include "emulator_models/soft_plc/function_blocks.hpp"
#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/plc/on_delay_scene.hpp"
#include "tests/scenarios/plc/plc_rig.hpp"
#include "tests/scenarios/plc/plc_scenes.hpp"

namespace scenarios {

void run_unmutated(ltsim::World& world, const PlcScene& scene) { soft_plc::run_scene(world, scene); }

}  // namespace scenarios

namespace {

using scenarios::PlcScene;
using scenarios::run_unmutated;

}  // namespace

SCENARIO("plc/threads", "a thread for each cycle; orders, and a program and a driver in trouble") {
  run_unmutated(world, scenarios::troubled_scene);
}

SCENARIO("plc/one-thread", "all cycles on one thread; orders, and a program and a driver in trouble") {
  run_unmutated(world, scenarios::one_thread_scene);
}

SCENARIO("plc/catch-up", "missed scans are made up for; the whole PLC may stand still for a while") {
  run_unmutated(world, scenarios::catch_up_scene);
}

SCENARIO("plc/gateway", "field devices ask through the gateway while each cycle runs on its thread") {
  run_unmutated(world, scenarios::gateway_scene);
}

SCENARIO("plc/gateway-one-thread",
         "field devices ask through the gateway while all cycles run on one thread") {
  run_unmutated(world, scenarios::gateway_one_thread_scene);
}

SHAPE("plc/o14-wall-clock",
      {.finding = "I21", .depth = 1, .tasks_count = 6, .cure = "the PLC runs on the monotonic clock"},
      "the PLC's watchdog runs on the clock that people set") {
  PlcScene scene{.clock_steps = 1, .only = "I21"};
  if (!corrected) scene.clock = PlcScene::Clock::wall;
  run_unmutated(world, scene);
}

SHAPE("plc/o15-millisecond-wrap",
      {.finding = "I20", .depth = 1, .tasks_count = 6, .cure = "the PLC counts nanoseconds in 64 bits"},
      "the PLC's clock is a count of milliseconds that wraps") {
  PlcScene scene{.hang = PlcScene::Hang::may, .only = "I20"};
  if (!corrected) scene.clock = PlcScene::Clock::milliseconds_32;
  run_unmutated(world, scene);
}

SHAPE("plc/o16-timer-wraps",
      {.finding = "timer", .depth = 1, .tasks_count = 2, .cure = "a timer that is done keeps Q and ET"},
      "the elapsed time of an on-delay timer is a TIME of 32 bits") {
  if (corrected) {
    scenarios::watch_on_delay<emulator_models::soft_plc::Ton>(world);
  } else {
    scenarios::watch_wrapping_on_delay(world);
  }
}

SHAPE("plc/o21-past-the-gate",
      {.finding = "I19",
       .depth = 2,
       .tasks_count = 6,
       .cure = "the driver's last write passes the gate once more"},
      "a driver writes a frame that a stop has overtaken") {
  PlcScene scene = scenarios::troubled_scene;
  scene.only = "I19";
  if (!corrected) scene.driver = PlcScene::Driver::past_gate;
  run_unmutated(world, scene);
}

SHAPE("plc/o22-live-inputs",
      {.finding = "I23", .depth = 2, .tasks_count = 6, .cure = "the program sees the image only"},
      "the program looks at the terminals themselves") {
  PlcScene scene = scenarios::troubled_scene;
  if (!corrected) scene.inputs = PlcScene::Inputs::live;
  run_unmutated(world, scene);
}

SHAPE("plc/word-by-word",
      {.finding = "I24", .depth = 1, .tasks_count = 6, .cure = "one write for all terminals"},
      "a driver writes the terminals of one cycle after those of the other") {
  PlcScene scene = scenarios::troubled_scene;
  if (!corrected) scene.driver = PlcScene::Driver::word_by_word;
  run_unmutated(world, scene);
}
