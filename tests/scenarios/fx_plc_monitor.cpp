#include "tests/scenarios/fx_plc_monitor.hpp"

#include <cstring>

namespace scenarios {
namespace {

using namespace emulator_models;
using protocol::fx::Device;
using protocol::fx::DeviceKind;
using soft_plc::RunMode;
using soft_plc::ScanAction;
using soft_plc::ScanStep;

constexpr Device first_analog_input{DeviceKind::d, 200};
constexpr Device first_analog_output{DeviceKind::d, 210};

bool are_off(const Terminals& terminals) {
  return terminals.outputs.none() && terminals.analog_outputs == decltype(terminals.analog_outputs){};
}

using Words = decltype(Terminals::analog_inputs);

Words words_at(const DeviceMemory& memory, Device first) {
  Words words;
  std::memcpy(words.data(), memory.bytes().data() + memory.place_of(first).byte_index, sizeof words);
  return words;
}

}  // namespace

void FxPlcMonitor::advanced(const FxPlc& plc, const ScanStep& step, SteadyTime now) {
  switch (step.action) {
    case ScanAction::system_analysis:
      judge_begin(now);
      break;
    case ScanAction::initialise:
      initialised_ = true;
      had_first_scan_ = false;
      break;
    case ScanAction::write_safe_outputs:
      initialised_ = false;
      break;
    case ScanAction::execute:
    case ScanAction::write_outputs:
      world_.require(now - begin_ <= limit_, "I20: a scan goes on that has lasted too long");
      world_.require(initialised_, "I25: a scan of RUN without an initialisation");
      world_.require(step.first_scan != had_first_scan_, "I25: not one first scan after a STOP");
      if (step.action == ScanAction::write_outputs) had_first_scan_ = true;
      break;
    case ScanAction::enter_fault:
      judge_fault(plc, now);
      break;
    case ScanAction::wait:
      if (!in_scan_) break;
      in_scan_ = false;
      end_.reset();
      if (plc.mode() == RunMode::run) end_ = now;
      break;
    default:
      break;
  }
  judge_outputs(plc.terminals(), plc.mode(), step.action);
}

void FxPlcMonitor::judge_begin(SteadyTime now) {
  // The scan is due no earlier than the one before has ended, and no later than a period after that.
  world_.require(!end_ || now - *end_ <= period_ + limit_, "I20: a scan begins that is too late");
  world_.require(now >= power_up_ + scans_count_ * period_, "I26: a scan begins too early");
  ++scans_count_;
  begin_ = now;
  in_scan_ = true;
}

void FxPlcMonitor::judge_fault(const FxPlc& plc, SteadyTime now) {
  initialised_ = false;
  const bool late = in_scan_ ? now - begin_ > limit_ : end_ && now - *end_ > limit_;
  end_.reset();
  if (plc.fault()->code == soft_plc::FaultCode::watchdog) {
    world_.require(late, "I21: the watchdog bites for nothing");
  } else {
    world_.violated("the program has failed");
  }
}

void FxPlcMonitor::judge_outputs(const Terminals& terminals, RunMode mode, ScanAction action) {
  const bool changed = terminals.outputs != seen_.outputs || terminals.analog_outputs != seen_.analog_outputs;
  if (changed) {
    seen_ = terminals;
    world_.require(action == ScanAction::write_outputs || are_off(terminals),
                   "I24: outputs change, and no scan writes them");
  }
  if (mode == RunMode::stop && (changed || mode_ != mode))
    world_.require(are_off(terminals), "I19: an output is on in STOP");
  mode_ = mode;
}

void FxPlcMonitor::look(const FxPlc& plc, DeviceMemory& memory) {
  if (plc.mode() != RunMode::run) return;  // a scan that a fault has cut short leaves its image cleared
  const Terminals& terminals = plc.terminals();
  world_.require(points_of(memory.inputs()) == terminals.inputs &&
                     words_at(memory, first_analog_input) == terminals.analog_inputs,
                 "I23: the input image is not what was latched");
  world_.require(points_of(memory.outputs()) == terminals.outputs &&
                     words_at(memory, first_analog_output) == terminals.analog_outputs,
                 "I24: the outputs are not those of the program");
}

}  // namespace scenarios
