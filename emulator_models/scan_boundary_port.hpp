// The programming port of a PLC that is scanned: a request waits until the scan serves it, in the system analysis.
//
// One request, one image: what a request reads and writes lies between two scans, whole, and its answer takes up to one
// scan. When nobody scans, it is given up after a bounded time and met with silence, as a PLC that hangs would. No scan
// lasts longer than D8000 allows, and none begins later than M8039 makes it: a request waits for these times and the
// port's patience on top of them.
//
// Invariants
//   I1  requests are executed in the order in which they came, each once or, when given up, not at all.
//   I2  serve() neither waits for a caller nor allocates.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>

#include "emulator_models/fx_plc_emulator.hpp"
#include "emulator_models/fx_plc_observer.hpp"

namespace emulator_models {

class ScanBoundaryPort final : public IPlcEmulator {
 public:
  /// Above the longest pause between two scans.
  static constexpr std::chrono::seconds default_patience{1};
  /// Requests that wait at once; one more is met with silence.
  static constexpr std::size_t waiting_max = 8;

  /// @param plc       must outlive this
  /// @param patience  how much longer than a scan may last a request waits; above the scan period
  explicit ScanBoundaryPort(FxPlcEmulator& plc,
                            std::chrono::nanoseconds patience = default_patience) noexcept;

  [[nodiscard]] protocol::fx::FrameBytes process(std::span<const std::byte> request) noexcept override;
  /// @param observer  of the requests that are executed, on the thread that serves; null: nobody
  void observe_with(FxPlcObserver* observer) noexcept;

  /// Executes all requests that wait. Called by the scan, which holds the memory.
  void serve(const FxPlcEmulator::LockedMemory& memory) noexcept;
  /// There will be no scan any more: executes what waits; a later request is met with silence at once.
  void close(const FxPlcEmulator::LockedMemory& memory) noexcept;

 private:
  struct Waiting {
    std::span<const std::byte> request;
    protocol::fx::FrameBytes answer;
    bool done = false;
  };

  void execute_all(const FxPlcEmulator::LockedMemory& memory) noexcept;
  void withdraw(const Waiting& waiting) noexcept;

  FxPlcEmulator& plc_;
  std::chrono::nanoseconds patience_;
  std::chrono::milliseconds scan_time_max_;  ///< of the scan that is under way, and the constant scan time
  bool closed_ = false;
  std::mutex mutex_;
  std::condition_variable answered_;
  std::array<Waiting*, waiting_max> queue_{};
  std::size_t queue_length_ = 0;
  FxPlcObserver* observer_ = nullptr;
};

}  // namespace emulator_models
