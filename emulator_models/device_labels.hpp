// What the devices of an FX PLC mean to a reader of its memory: of the PLC itself, and of the plant behind it.
#pragma once

#include <span>
#include <string_view>

#include "emulator_models/plant_choice.hpp"
#include "protocol/fx/address_map.hpp"

namespace emulator_models {

struct DeviceLabel {
  protocol::fx::Device device;
  std::string_view text;  ///< at most 19 characters
};

/// In the order in which a screen shows them. A model need not have all of them.
[[nodiscard]] std::span<const DeviceLabel> labels_of(PlantKind plant) noexcept;

}  // namespace emulator_models
