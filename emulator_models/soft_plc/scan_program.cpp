#include "emulator_models/soft_plc/scan_program.hpp"

namespace emulator_models::soft_plc {

Progress perform(const ScanStep& step, ScanProgram& program) noexcept {
  switch (step.action) {
    case ScanAction::system_analysis:
      program.system_analysis();
      break;
    case ScanAction::clear_fault:
      program.set_alarm_lamp(false);
      break;
    case ScanAction::initialise:
      program.initialise(step.start);
      break;
    case ScanAction::write_safe_outputs:
      program.write_safe_outputs();
      break;
    case ScanAction::read_inputs:
      program.read_inputs();
      break;
    case ScanAction::read_from_cycles:
      program.read_from_cycles();
      break;
    case ScanAction::execute:
      return program.execute(step);
    case ScanAction::write_to_cycles:
      program.write_to_cycles();
      break;
    case ScanAction::write_outputs:
      program.refresh_output_image();
      program.write_outputs();
      break;
    case ScanAction::refresh_output_image:
      program.refresh_output_image();
      break;
    case ScanAction::wait:
      break;
    case ScanAction::enter_fault:
      // In this order: who sees the lamp can rely on the outputs.
      program.write_safe_outputs();
      program.set_alarm_lamp(true);
      break;
  }
  return Progress::finished;
}

}  // namespace emulator_models::soft_plc
