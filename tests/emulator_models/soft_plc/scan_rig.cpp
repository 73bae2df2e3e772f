#include "tests/emulator_models/soft_plc/scan_rig.hpp"

namespace emulator_models::soft_plc {

void ScanRig::run_until_wait(ScanTask& task) {
  for (Progress last = Progress::finished;;) {
    const ScanStep step = task.next(now, last);
    if (step.action == ScanAction::wait) return;
    last = perform(step, *this);
  }
}

Progress ScanRig::execute(const ScanStep& step) noexcept {
  last_execute = step;
  spend('X', ScanAction::execute);
  if (fails) return Progress::failed;
  if (++slices_done_ < slices_per_scan) return Progress::unfinished;
  slices_done_ = 0;
  return Progress::finished;
}

void ScanRig::write_safe_outputs() noexcept {
  slices_done_ = 0;
  spend('S', ScanAction::write_safe_outputs);
}

void ScanRig::spend(char letter, ScanAction action) noexcept {
  calls += letter;
  const std::chrono::nanoseconds half = duration_of(action) / 2;
  now += half;
  during(action);
  now += duration_of(action) - half;
}

}  // namespace emulator_models::soft_plc
