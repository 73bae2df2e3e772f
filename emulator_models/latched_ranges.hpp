// Which devices keep their values over STOP and over loss of power: the ranges as the models are delivered
// (FX manuals). On a real PLC parameters move their borders; here they are fixed.
//
//            M               S             C (and C200 on)            D            T
//   FX1S     384-511         0-127         16-31                      128-255      none
//   FX1N     384-1535        0-999         16-199, 220-234            128-7999     246-255
//   FX2N     500-3071        500-999       100-199, 220-234           200-7999     246-255
//   FX3U     500-7679        500-4095      100-199, 220-234           200-7999     246-255
//
// D200 to D217 are wired to the terminals and latched on no model.
#pragma once

#include "emulator_models/device_memory.hpp"

namespace emulator_models {

/// From RUN to STOP: clears Y and what is not latched of M, S, T, C and D. X and the special devices stay.
void clear_unlatched(DeviceMemory& memory) noexcept;
/// A cold start: clears latched devices, too.
void clear_all_but_special(DeviceMemory& memory) noexcept;

}  // namespace emulator_models
