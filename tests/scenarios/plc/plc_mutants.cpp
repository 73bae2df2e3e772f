// The soft PLC with one rule taken away: compiled once for each, with the sources that it is a mutant of.

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/plc/plc_rig.hpp"
#include "tests/scenarios/plc/plc_scenes.hpp"

namespace {

void run(ltsim::World& world, bool corrected, const scenarios::PlcScene& scene) {
  if (corrected) {
    scenarios::run_unmutated(world, scene);
  } else {
    scenarios::soft_plc::run_scene(world, scene);
  }
}

}  // namespace

#if defined(LTSIM_MUTANT_MODE_READ_TWICE)
SHAPE("plc/o20-mode-read-twice",
      {.finding = "I25", .depth = 2, .tasks_count = 6, .cure = "the mode of a scan is set once"},
      "a scan looks at the mode that is ordered again after it has read its inputs") {
  run(world, corrected, scenarios::troubled_scene);
}

#elif defined(LTSIM_MUTANT_MODE_SAMPLED)
SHAPE("plc/stop-between-two-scans",
      {.finding = "I25",
       .depth = 1,
       .tasks_count = 6,
       .cure = "that STOP was ordered is kept until a scan has seen it"},
      "STOP and RUN between two looks at the mode are not noticed") {
  run(world, corrected, scenarios::troubled_scene);
}

#elif defined(LTSIM_MUTANT_COMMIT_OF_ANY_RUN)
SHAPE("plc/o21-commit-of-any-run",
      {.finding = "I19", .depth = 3, .tasks_count = 6, .cure = "a commit names its run"},
      "the gate lets through what a scan of an older run commits") {
  run(world, corrected, scenarios::troubled_scene);
}

#elif defined(LTSIM_MUTANT_COMMIT_TESTED_BEFORE)
SHAPE("plc/o21-commit-tested-before",
      {.finding = "I19",
       .depth = 2,
       .tasks_count = 6,
       .cure = "one critical section for the test and the outputs"},
      "the gate tests a commit, and writes its outputs after a stop") {
  run(world, corrected, scenarios::troubled_scene);
}

#elif defined(LTSIM_MUTANT_WATCHDOG_FED_BY_DRIVERS)
SHAPE(
    "plc/o17-watchdog-fed-by-drivers",
    {.finding = "I20", .depth = 1, .tasks_count = 6, .cure = "only the end of a whole scan earns more time"},
    "a scan hangs, and the driver's thread goes on feeding the watchdog") {
  run(world, corrected, scenarios::hanging_scene);
}

#elif defined(LTSIM_MUTANT_WATCHDOG_FED_BY_SLICES)
SHAPE(
    "plc/watchdog-fed-by-slices",
    {.finding = "I22", .depth = 1, .tasks_count = 6, .cure = "only the end of a whole scan earns more time"},
    "each slice of an endless program feeds the watchdog") {
  run(world, corrected, scenarios::troubled_scene);
}

#elif defined(LTSIM_MUTANT_WATCHDOG_OF_ANY_RUN)
SHAPE("plc/o18-watchdog-against-restart",
      {.finding = "I21",
       .depth = 3,
       .tasks_count = 6,
       .cure = "one critical section for the look and the stop"},
      "the watchdog finds one run over its time and stops the next") {
  run(world, corrected, scenarios::restarted_scene);
}

#elif defined(LTSIM_MUTANT_PLAIN_MUTEX)
SHAPE("plc/o12-plain-mutex",
      {.finding = "I20",
       .depth = 2,
       .tasks_count = 6,
       .cure = "who holds a mutex inherits the priority of who waits"},
      "a scan that hangs keeps the driver from giving back the mutex that the watchdog waits for") {
  run(world, corrected, scenarios::realtime_scene);
}

#elif defined(LTSIM_MUTANT_CATCH_UP_WITHOUT_BOUND)
SHAPE("plc/o19-catch-up-without-bound",
      {.finding = "I26",
       .depth = 1,
       .tasks_count = 6,
       .cure = "at most 100 scans are made up for, the rest is lost and counted"},
      "each scan that was missed is made up for") {
  run(world, corrected, scenarios::catch_up_scene);
}

#elif defined(LTSIM_MUTANT_GATEWAY_BETWEEN_SLICES)
SHAPE("plc/gateway-between-slices",
      {.finding = "gateway",
       .depth = 1,
       .tasks_count = 8,
       .cure = "requests are carried out before a scan, and not within it"},
      "a request through the gateway need not wait for the end of a scan") {
  run(world, corrected, scenarios::gateway_scene);
}

#elif defined(LTSIM_MUTANT_GATEWAY_KEEPS_GIVEN_UP)
SHAPE("plc/gateway-keeps-given-up",
      {.finding = "gateway",
       .depth = 1,
       .tasks_count = 8,
       .cure = "who gives a request up takes it out of the queue"},
      "a request through the gateway whose time is over stays in the queue") {
  run(world, corrected, scenarios::gateway_one_thread_scene);
}

#else
#error "which mutant?"
#endif
