// What the cycles of a soft PLC have done, as text for a person: late starts as a histogram, scan times, overruns, lost
// starts, drivers, faults. Nothing that was counted is left out.
#pragma once

#include <string>

#include "emulator_models/soft_plc/configured_plc.hpp"

namespace emulator_models {

/// @param plc  of that configuration
/// @return     lines, for all cycles and drivers
[[nodiscard]] std::string cycle_report(const soft_plc::PlcConfiguration& configuration,
                                       soft_plc::SoftPlc& plc, std::chrono::nanoseconds now);

/// One cycle's part of it.
[[nodiscard]] std::string cycle_report(const std::string& name, std::chrono::nanoseconds period,
                                       const soft_plc::CycleStatus& status,
                                       const soft_plc::StartDelays& delays);

/// "values of cycle fast after scan 1234, at 12.345 s: %QX0.0 = 1, %MW9 = 255 (16#00FF)"
/// @param signals  their addresses, in the order of the values
[[nodiscard]] std::string values_report(const std::string& name, const std::vector<std::string>& signals,
                                        const soft_plc::RealTimeReading& reading);

/// "watchdog (1): the scan was longer than its limit; after 150.012 ms of scan 1234, in execute"
[[nodiscard]] std::string to_string(const soft_plc::Fault& fault);

}  // namespace emulator_models
