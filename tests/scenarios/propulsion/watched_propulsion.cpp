#include "tests/scenarios/propulsion/watched_propulsion.hpp"

#include <thread>

namespace scenarios {
namespace {

using namespace emulator_models;
using protocol::fx::Device;
using protocol::fx::DeviceKind;

constexpr std::chrono::milliseconds watchdog_limit{200};

PropulsionContract contract_in(const DeviceMemory& memory) {
  PropulsionContract contract;
  for (std::size_t i = 0; i < PropulsionContract::count; ++i) {
    const auto number = static_cast<std::uint16_t>(PropulsionContract::first + i);
    contract.bits[i] = memory.get(Device{DeviceKind::m, number}) != 0;
    contract.words[i] = static_cast<std::int16_t>(memory.get(Device{DeviceKind::d, number}));
  }
  return contract;
}

}  // namespace

WatchedPropulsion::WatchedPropulsion(ltsim::World& world, const soft_plc::IlProgram& program,
                                     std::chrono::nanoseconds period, std::string_view only_rule)
    : world_{world},
      only_{only_rule},
      plc_{emulator_,
           program,
           [this](Terminals& terminals, SteadyTime now) { plant_.advance(terminals, now); },
           &port_,
           {.period = period, .watchdog_limit = watchdog_limit},
           SteadyTime{}},
      monitor_{world, period, watchdog_limit, SteadyTime{}} {}

void WatchedPropulsion::scan() {
  for (;;) {
    const SteadyTime now = std::chrono::steady_clock::now();
    const soft_plc::ScanStep step = plc_.advance(now, std::chrono::system_clock::now());
    if (only_.empty()) monitor_.advanced(plc_, step, now);
    if (step.action == soft_plc::ScanAction::initialise) rules_.run_begins();
    if (step.action != soft_plc::ScanAction::wait) continue;
    look(SteadyTime{step.scan_start});
    if (stop_requested_.load()) return;
    std::this_thread::sleep_until(SteadyTime{step.until});
  }
}

void WatchedPropulsion::look(SteadyTime scan_start) {
  const ltsim::GhostScope ghost;
  emulator_.with_memory([&](DeviceMemory& memory) {
    if (only_.empty()) monitor_.look(plc_, memory);
    if (plc_.mode() == soft_plc::RunMode::run) judge(memory, scan_start);
  });
}

void WatchedPropulsion::judge(DeviceMemory& memory, SteadyTime scan_start) {
  rules_.observe(plc_.terminals(), contract_in(memory), scan_start);
  const BrokenPropulsionRules& broken = rules_.broken();
  for (std::size_t i = 0; i < broken.size() && broken.any(); ++i) {
    const std::string_view rule = name_of(static_cast<PropulsionRule>(i));
    if (broken.test(i) && (only_.empty() || rule == only_)) world_.violated(std::string{rule});
  }
}

}  // namespace scenarios
