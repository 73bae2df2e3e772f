// Scans an FxPlc in real time, in one thread, until it is asked to stop, and tells of faults that come and go.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "emulator_models/fx_plc.hpp"

namespace emulator_models {

class FxPlcLoop {
 public:
  /// Called on the thread that scans, between two scans, the memory unlocked: a new fault, or none any more.
  using FaultListener = std::function<void(const FxPlc&)>;

  /// @param plc       must outlive this; nobody else advances it
  /// @param listener  may be empty; must not throw. The next scan waits for it
  explicit FxPlcLoop(FxPlc& plc, FaultListener listener = {}) noexcept
      : plc_{plc}, listener_{std::move(listener)} {}

  /// Scans until request_stop(); a scan under way is finished first, an endless one by the watchdog.
  void run() noexcept;
  /// From any thread, not from a signal handler.
  void request_stop() noexcept;

 private:
  void report_fault();

  FxPlc& plc_;
  FaultListener listener_;
  std::optional<soft_plc::Fault> reported_fault_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_requested_ = false;
};

}  // namespace emulator_models
