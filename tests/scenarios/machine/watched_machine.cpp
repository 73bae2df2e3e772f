#include "tests/scenarios/machine/watched_machine.hpp"

#include <string>
#include <thread>

#include <fmt/format.h>

namespace scenarios {
namespace {

using namespace emulator_models;
using protocol::fx::Device;
using protocol::fx::DeviceKind;

/// Two scans, and the way to the terminals, in periods.
constexpr int reaction_periods = 3;

MachineToolContract contract_in(const DeviceMemory& memory, bool plc_runs) {
  const auto on = [&](std::uint16_t number) { return memory.get(Device{DeviceKind::m, number}) != 0; };
  const auto word = [&](std::uint16_t number) {
    return static_cast<std::uint16_t>(memory.get(Device{DeviceKind::d, number}));
  };
  return {.m_code = word(100),
          .selected_tool = word(220),
          .warning_number = word(121),
          .m_strobe = on(100),
          .s_strobe = on(101),
          .t_strobe = on(102),
          .distribution_end = on(103),
          .reset = on(105),
          .z_at_change = on(107),
          .fin = on(120),
          .alarm = on(121),
          .feed_enable = on(125),
          .plc_runs = plc_runs};
}

}  // namespace

WatchedMachine::WatchedMachine(ltsim::World& world, const soft_plc::IlProgram& program,
                               FunctionMonitor& functions, std::chrono::nanoseconds period,
                               PortService service)
    : world_{world},
      functions_{functions},
      period_{period},
      service_{service},
      plc_{emulator_,
           program,
           [this](Terminals& terminals, SteadyTime now) { plant_.advance(terminals, now); },
           &port_,
           {.period = period, .watchdog_limit = {}},
           SteadyTime{}},
      rules_{reaction_periods * period} {}

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
  constexpr Device tool_in_spindle{DeviceKind::d, 221};
  constexpr Device exchange{DeviceKind::d, 223};
  constexpr std::uint16_t first_pocket = 230;
  const machine_tool::ToolChanger& changer = plant_.changer();
  emulator_.with_memory([&](DeviceMemory& memory) {
    if (memory.get(exchange) == 0) return;
    memory.set(tool_in_spindle, changer.tool_in_spindle());
    for (std::uint16_t i = 0; i < machine_tool::ToolChanger::pockets_count; ++i)
      memory.set({DeviceKind::d, static_cast<std::uint16_t>(first_pocket + i)},
                 changer.tool_in_pocket(i + 1U));
    memory.set(exchange, 0);
  });
}

void WatchedMachine::look(SteadyTime now) {
  const ltsim::GhostScope ghost;
  scanned_time_ += std::min<std::chrono::nanoseconds>(now - last_look_, period_);
  last_look_ = now;
  MachineToolRules::Broken broken;
  emulator_.with_memory([&](const DeviceMemory& memory) {
    const bool runs = plc_.mode() == soft_plc::RunMode::run;
    broken = rules_.look(plc_.terminals(), plant_, contract_in(memory, runs), scanned_time_);
    functions_.scanned(memory);
  });
  for (std::size_t i = 0; i < broken.size() && broken.any(); ++i) {
    const std::string_view rule = name_of(static_cast<MachineToolRule>(i));
    if (broken.test(i) && (only_.empty() || rule == only_)) world_.violated(std::string{rule});
  }
}

}  // namespace scenarios
