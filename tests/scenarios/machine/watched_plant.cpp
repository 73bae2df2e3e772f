#include "tests/scenarios/machine/watched_plant.hpp"

#include <algorithm>

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

WatchedPlant::WatchedPlant(ltsim::World& world, FunctionMonitor& functions, std::chrono::nanoseconds period)
    : world_{world}, functions_{functions}, period_{period}, rules_{reaction_periods * period} {}

void WatchedPlant::look(const FxPlc& plc, const DeviceMemory& memory, SteadyTime now) {
  look(plc.terminals(), contract_in(memory, plc.mode() == soft_plc::RunMode::run), now);
  functions_.scanned(memory);
}

void WatchedPlant::pass_without_plc() {
  const ltsim::GhostScope ghost;
  Terminals dropped;
  for (SteadyTime now = last_look_ + period_; now <= SteadyTime{world_.now()}; now += period_) {
    plant_.advance(dropped, now);
    look(dropped, {.plc_runs = false}, now);
  }
  functions_.plc_is_dead();
}

void WatchedPlant::look(const Terminals& terminals, const MachineToolContract& contract, SteadyTime now) {
  scanned_time_ += std::min<std::chrono::nanoseconds>(now - last_look_, period_);
  last_look_ = now;
  const MachineToolRules::Broken broken = rules_.look(terminals, plant_, contract, scanned_time_);
  for (std::size_t i = 0; i < broken.size() && broken.any(); ++i) {
    const std::string_view rule = name_of(static_cast<MachineToolRule>(i));
    if (broken.test(i) && (only_.empty() || rule == only_)) world_.violated(std::string{rule});
  }
}

}  // namespace scenarios
