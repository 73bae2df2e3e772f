// A driver: what lies between the terminals of the PLC and a field bus, a card, or a simulated plant.
#pragma once

#include <cstddef>
#include <span>

#include "emulator_models/soft_plc/output_gate.hpp"

namespace emulator_models::soft_plc {

class IoDriver {
 public:
  virtual ~IoDriver() = default;

  /// One exchange with the field, on a thread of the driver's own; it may take its time. Just before the hardware the
  /// outputs go through gate.write_through(frame, ...): what a stop has overtaken must not arrive.
  /// @param frame   one committed set of all outputs of the PLC; the driver uses its section
  /// @param inputs  the driver's section, to be filled; of no meaning after a failure
  /// @return        whether the inputs are good
  [[nodiscard]] virtual bool exchange(const OutputGate::Frame& frame, OutputGate& gate,
                                      std::span<std::byte> inputs) noexcept = 0;

 protected:
  IoDriver() = default;
  IoDriver(const IoDriver&) = default;
  IoDriver& operator=(const IoDriver&) = default;
};

}  // namespace emulator_models::soft_plc
