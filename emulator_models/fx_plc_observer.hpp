// Who watches an FxPlc: called on the thread that scans, in the middle of a scan. So it must neither wait nor throw nor
// call back.
#pragma once

#include <cstddef>
#include <span>

#include "emulator_models/device_memory.hpp"
#include "emulator_models/special_devices.hpp"
#include "protocol/fx/frame.hpp"

namespace emulator_models {

class FxPlc;

class FxPlcObserver {
 public:
  virtual ~FxPlcObserver() = default;

  /// After each step that the scan task has ordered, before it is carried out.
  /// @param memory  locked; null between two scans. With the step `wait` it is that of a whole scan
  virtual void step_ordered(const FxPlc& plc, const DeviceMemory* memory, SteadyTime now) noexcept = 0;
  /// A request of the programming port has been executed, in the system analysis.
  virtual void request_served(std::span<const std::byte> request,
                              const protocol::fx::FrameBytes& answer) noexcept = 0;

 protected:
  FxPlcObserver() = default;
  FxPlcObserver(const FxPlcObserver&) = default;
  FxPlcObserver& operator=(const FxPlcObserver&) = default;
};

}  // namespace emulator_models
