// Scans an FxPlc in real time, in one thread, until it is asked to stop.
#pragma once

#include <condition_variable>
#include <mutex>

#include "emulator_models/fx_plc.hpp"

namespace emulator_models {

class FxPlcLoop {
 public:
  /// @param plc  must outlive this; nobody else advances it
  explicit FxPlcLoop(FxPlc& plc) noexcept : plc_{plc} {}

  /// Scans until request_stop(); a scan under way is finished first, an endless one by the watchdog.
  void run() noexcept;
  /// From any thread, not from a signal handler.
  void request_stop() noexcept;

 private:
  FxPlc& plc_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_requested_ = false;
};

}  // namespace emulator_models
