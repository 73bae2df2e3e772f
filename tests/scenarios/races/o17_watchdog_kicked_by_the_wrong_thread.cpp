// The communication thread kicks the watchdog, so a scan that hangs is never noticed (RespiraWorks/Ventilator #811,
// Zephyr #40152).
//
// For memory sc. With c11 the corrected program is accused, too: no store has a time by which it is seen, and a watchdog that sees a kick
// one period late stops the scan one period late.

#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Plc {
  std::atomic<std::uint32_t> kicks, stopped, finished;
};

}  // namespace

SHAPE("races/o17-watchdog-kicked-by-the-wrong-thread",
      {.finding = "I20", .depth = 1, .tasks_count = 3, .cure = "only the end of a whole scan kicks"},
      "a scan hangs and another thread goes on kicking") {
  races::name_words(world, "plc", {"kicks", "stopped", "finished"});
  int scan_begun = 0;  // the last scan that has begun, from 1
  int scan_ended = 0;

  world.process("plc").start("scan", [&] {
    const races::Shared<Plc> plc{"plc"};
    for (int scan = 0; scan < 5 && plc->stopped == 0; ++scan) {
      ++scan_begun;
      std::this_thread::sleep_for(races::Milliseconds{2});  // the program; it may hang here
      if (corrected) ++plc->kicks;
      ++scan_ended;
    }
    plc->finished = 1;
  });
  world.process("plc").start("communication", [&] {
    const races::Shared<Plc> plc{"plc"};
    while (plc->finished == 0) {
      if (!corrected) ++plc->kicks;
      std::this_thread::sleep_for(races::Milliseconds{5});
    }
  });
  world.process("plc").start("watchdog", [&] {
    const races::Shared<Plc> plc{"plc"};
    std::uint32_t kicks_seen = plc->kicks;
    int scan_seen = scan_begun;
    while (plc->finished == 0) {
      std::this_thread::sleep_for(races::Milliseconds{10});
      const std::uint32_t kicks = plc->kicks;
      if (kicks == kicks_seen) {
        plc->stopped = 1;
        return;
      }
      world.require(scan_seen <= scan_ended,
                    "I20: a scan lasts longer than the watchdog's time, and the watchdog does not stop it");
      kicks_seen = kicks;
      scan_seen = scan_begun;
    }
  });
  world.run();
}
