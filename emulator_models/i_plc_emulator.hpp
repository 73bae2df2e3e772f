// What the emulator process offers to whoever brings it a request: a PLC of some type, seen through its
// programming port.
#pragma once

#include <cstddef>
#include <span>

#include "protocol/fx/frame.hpp"

namespace emulator_models {

class IPlcEmulator {
 public:
  virtual ~IPlcEmulator() = default;

  /// Executes one message of the programming port. May be called from several threads.
  /// @param request  one message as it came: ENQ, or a frame from STX to sum; anything else is allowed, too
  /// @return         the answer; empty = the PLC stays silent
  [[nodiscard]] virtual protocol::fx::FrameBytes process(std::span<const std::byte> request) noexcept = 0;

 protected:
  IPlcEmulator() = default;
  IPlcEmulator(const IPlcEmulator&) = default;
  IPlcEmulator& operator=(const IPlcEmulator&) = default;
};

}  // namespace emulator_models
