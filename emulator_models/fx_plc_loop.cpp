#include "emulator_models/fx_plc_loop.hpp"

namespace emulator_models {

void FxPlcLoop::run() noexcept {
  for (WallTime wall = std::chrono::system_clock::now();;) {
    const soft_plc::ScanStep step = plc_.advance(std::chrono::steady_clock::now(), wall);
    if (step.action != soft_plc::ScanAction::wait) continue;
    report_fault();
    std::unique_lock lock{mutex_};
    if (stopped_.wait_until(lock, SteadyTime{step.until}, [this] { return stop_requested_; })) return;
    wall = std::chrono::system_clock::now();
  }
}

void FxPlcLoop::report_fault() {
  if (plc_.fault() == reported_fault_) return;
  reported_fault_ = plc_.fault();
  if (listener_) listener_(plc_);
}

void FxPlcLoop::request_stop() noexcept {
  {
    const std::lock_guard lock{mutex_};
    stop_requested_ = true;
  }
  stopped_.notify_all();
}

}  // namespace emulator_models
