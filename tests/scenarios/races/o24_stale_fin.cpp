// The kernel raises the next strobe before the PLC has seen the last one fall: the old FIN ends the new M code, which
// is never executed (LinuxCNC iocontrol v1, ToolchangerProtocolProposal; LinuxCNC #412).

#include <array>
#include <thread>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

struct Signals {
  std::atomic<std::uint32_t> m_code, fin, program_ended;
};

}  // namespace

SHAPE("races/o24-stale-fin",
      {.finding = "I27",
       .depth = 1,
       .tasks_count = 2,
       .cure = "the kernel waits for FIN to fall before each strobe"},
      "the FIN of one M code ends the next") {
  constexpr std::uint32_t codes_count = 2;
  races::name_words(world, "signals", {"m-code", "fin", "program-ended"});
  std::array<bool, codes_count + 1> executed{};

  world.process("plc").start("scan", [&] {
    const races::Shared<Signals> signals{"signals"};
    while (signals->program_ended == 0) {
      const std::uint32_t m_code = signals->m_code;
      if (m_code != 0 && signals->fin == 0) {
        executed[m_code] = true;
        signals->fin = 1;
      }
      if (m_code == 0) signals->fin = 0;
      std::this_thread::yield();
    }
  });
  world.process("kernel").start("main", [&] {
    const races::Shared<Signals> signals{"signals"};
    for (std::uint32_t m_code = 1; m_code <= codes_count; ++m_code) {
      while (corrected && signals->fin != 0) std::this_thread::yield();
      signals->m_code = m_code;
      while (signals->fin == 0) std::this_thread::yield();
      world.require(executed[m_code], "I27: an M code has its FIN and was not executed");
      signals->m_code = 0;
    }
    signals->program_ended = 1;
  });
  world.run();
}
