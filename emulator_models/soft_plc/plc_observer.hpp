// Who watches a SoftPlc: called on the thread of the cycle, in the middle of its scan. So it must neither wait nor throw
// nor call back; values_of() is for any thread.
#pragma once

#include <chrono>
#include <cstddef>

#include "emulator_models/soft_plc/cycle_body.hpp"
#include "emulator_models/soft_plc/il_error.hpp"
#include "emulator_models/soft_plc/scan_task.hpp"

namespace emulator_models::soft_plc {

struct GatewayItem;
class RealTimeValues;

class PlcObserver {
 public:
  virtual ~PlcObserver() = default;

  /// After a step that the task of a cycle has ordered, before it is carried out; under the PLC's lock. When all cycles
  /// share a thread it is called for each of them after a step of any.
  /// @param image  whole between two scans
  virtual void step_ordered(std::size_t cycle, const ScanTask& task, const CycleImage& image,
                            std::chrono::nanoseconds now) noexcept = 0;
  /// In phase 4 of a scan of the cycle, before the step with which its task enters the fault program_failed.
  virtual void program_failed(std::size_t cycle, SourcePlace place) noexcept = 0;
  /// In phase 1 of a scan of the cycle: what a field device writes.
  virtual void gateway_writes(std::size_t cycle, const GatewayItem& item) noexcept = 0;
  /// @return what any thread may read of the cycle's latest scan; nullptr: nothing is kept
  [[nodiscard]] virtual const RealTimeValues* values_of(std::size_t /*cycle*/) const noexcept {
    return nullptr;
  }

 protected:
  PlcObserver() = default;
  PlcObserver(const PlcObserver&) = default;
  PlcObserver& operator=(const PlcObserver&) = default;
};

}  // namespace emulator_models::soft_plc
