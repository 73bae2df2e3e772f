// The archive that a configuration asks for: an observer of one PLC that writes the file as long as it lives.
//
// Its end, after the PLC's last scan, stores what is left and tells how much was stored and lost. In the file, cycles have
// the numbers of their order in the configuration, signals are called by their addresses.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/plc_configuration.hpp"
#include "emulator_models/soft_plc/plc_observer.hpp"

namespace emulator_models {

/// @param power_up  of the PLC, on steady_clock
/// @param tell      called with a line for the operator, also by the archive's thread
/// @return          nullptr without a path; or why the file cannot be had, and the way out
[[nodiscard]] tl::expected<std::unique_ptr<soft_plc::PlcObserver>, std::string> open_configured_archive(
    const soft_plc::PlcConfiguration& configuration, std::chrono::nanoseconds power_up,
    const std::function<void(const std::string&)>& tell);

}  // namespace emulator_models
