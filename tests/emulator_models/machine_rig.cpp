#include "tests/emulator_models/machine_rig.hpp"

#include <utility>

namespace emulator_models {
namespace {

using namespace std::chrono_literals;

protocol::fx::Device device_of(std::string_view name) {
  return protocol::fx::parse_device(name, protocol::fx::Model::fx3u).value();
}

std::string text(const char* what, FunctionKind kind, std::uint16_t number) {
  constexpr char letters[] = {'M', 'S', 'T'};
  return std::string{what} + ' ' + letters[static_cast<std::size_t>(kind)] + std::to_string(number);
}

}  // namespace

void RecordingObserver::action_started(FunctionKind kind, std::uint16_t number) noexcept {
  events.push_back(text("start", kind, number));
}

void RecordingObserver::action_finished(FunctionKind kind, std::uint16_t number) noexcept {
  events.push_back(text("finish", kind, number));
}

void MachineRig::run_for(std::chrono::milliseconds duration) {
  do {
    scan.scan_once(now, wall);
    now += ScanCycle::default_period;
    wall += ScanCycle::default_period;
    duration -= ScanCycle::default_period;
  } while (duration > 0ms);
}

std::chrono::milliseconds MachineRig::run_until_on(std::string_view device) {
  constexpr std::chrono::milliseconds limit = 20s;
  const SteadyTime start = now;
  while (get(device) == 0 && now - start < limit) scan_once();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now - start);
}

unsigned MachineRig::get(std::string_view device) {
  return plc.with_memory([&](const DeviceMemory& memory) { return memory.get(device_of(device)); });
}

void MachineRig::set(std::string_view device, unsigned value) {
  plc.with_memory([&](DeviceMemory& memory) { memory.set(device_of(device), value); });
}

bool MachineRig::output(std::string_view device) const {
  return scan.terminals().outputs.test(device_of(device).number);
}

std::vector<std::string> MachineRig::take_events() { return std::exchange(observer.events, {}); }

}  // namespace emulator_models
