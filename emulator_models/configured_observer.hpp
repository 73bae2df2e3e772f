// Who watches a configured PLC as long as it lives: its archive and its real-time values, as far as the configuration asks
// for them.
//
// The archive's end, after the PLC's last scan, stores what is left and tells how much was stored and lost. In the file,
// cycles have the numbers of their order in the configuration, signals are called by their addresses.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "emulator_models/soft_plc/plc_configuration.hpp"
#include "emulator_models/soft_plc/plc_observer.hpp"

namespace emulator_models {

/// @param power_up  of the PLC, on steady_clock
/// @param tell      called with a line for the operator, also by the archive's thread
/// @return          nullptr if nothing is asked for; or why the archive's file cannot be had, and the way out
[[nodiscard]] tl::expected<std::unique_ptr<soft_plc::PlcObserver>, std::string> make_configured_observer(
    const soft_plc::PlcConfiguration& configuration, std::chrono::nanoseconds power_up,
    const std::function<void(const std::string&)>& tell);

}  // namespace emulator_models
