// The watchdog sees that run 1 is over its time; the operator stops it and starts run 2; the watchdog acts, and stops
// run 2 (reactor-c PR #417, lingua-franca #2150).

#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

/// 0: stopped; otherwise the number of the run.
struct Controller {
  std::atomic<std::uint32_t> run;
};

}  // namespace

SHAPE("races/o18-watchdog-against-restart",
      {.finding = "I21",
       .depth = 2,
       .tasks_count = 2,
       .cure = "the watchdog stops the run that it has looked at, by its number"},
      "the watchdog expires for one run and stops the next") {
  races::name_words(world, "controller", {"run"});

  world.process("controller").start("operator", [&] {
    const races::Shared<Controller> controller{"controller"};
    controller->run = 1;
    std::this_thread::sleep_for(races::Milliseconds{10});
    controller->run = 0;  // stop
    controller->run = 2;  // start
  });
  world.process("controller").start("watchdog", [&] {
    const races::Shared<Controller> controller{"controller"};
    std::this_thread::sleep_for(races::Milliseconds{10});
    std::uint32_t expired = controller->run;
    if (expired != 1) return;  // stopped in time
    if (corrected) {
      controller->run.compare_exchange_strong(expired, 0);
      return;
    }
    const std::uint32_t stopped = controller->run.exchange(0);
    world.require(stopped != 2, "I21: the watchdog stops run 2, which has just begun");
  });
  world.run();
}
