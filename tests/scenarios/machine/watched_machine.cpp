#include "tests/scenarios/machine/watched_machine.hpp"

#include <chrono>
#include <thread>

namespace scenarios {
namespace {

using namespace emulator_models;
using protocol::fx::Device;
using protocol::fx::DeviceKind;

// The tool table.
constexpr Device tool_in_spindle{DeviceKind::d, 221};
constexpr Device exchange{DeviceKind::d, 223};
constexpr std::uint16_t first_of_table = 220;
constexpr std::uint16_t first_pocket = 230;
constexpr std::uint16_t last_of_table = 241;

}  // namespace

WatchedMachine::WatchedMachine(WatchedPlant& plant, const soft_plc::IlProgram& program, PortService service,
                               SteadyTime now)
    : plant_{plant},
      service_{service},
      plc_{emulator_,
           program,
           [this](Terminals& terminals, SteadyTime at) { plant_.plant().advance(terminals, at); },
           &port_,
           {.period = plant.period(), .watchdog_limit = {}},
           now} {}

void WatchedMachine::scan() {
  for (;;) {
    const SteadyTime now = std::chrono::steady_clock::now();
    const soft_plc::ScanStep step = plc_.advance(now, std::chrono::system_clock::now());
    if (step.action != soft_plc::ScanAction::wait) continue;
    look(now);
    if (stop_requested_.load()) return;
    std::this_thread::sleep_until(SteadyTime{step.until});
  }
}

void WatchedMachine::put_tool_table_right() {
  const machine_tool::ToolChanger& changer = plant_.plant().changer();
  emulator_.with_memory([&](DeviceMemory& memory) {
    if (memory.get(exchange) == 0) return;
    memory.set(tool_in_spindle, changer.tool_in_spindle());
    for (std::uint16_t i = 0; i < machine_tool::ToolChanger::pockets_count; ++i)
      memory.set({DeviceKind::d, static_cast<std::uint16_t>(first_pocket + i)},
                 changer.tool_in_pocket(i + 1U));
    memory.set(exchange, 0);
  });
}

void WatchedMachine::keep_latched(WatchedMachine& dead) {
  dead.emulator_.with_memory([&](const DeviceMemory& left) {
    emulator_.with_memory([&](DeviceMemory& memory) {
      for (std::uint16_t number = first_of_table; number <= last_of_table; ++number)
        memory.set({DeviceKind::d, number}, left.get({DeviceKind::d, number}));
    });
  });
}

void WatchedMachine::look(SteadyTime now) {
  const ltsim::GhostScope ghost;
  emulator_.with_memory([&](const DeviceMemory& memory) { plant_.look(plc_, memory, now); });
}

}  // namespace scenarios
