#include "emulator_models/plant_drivers.hpp"

#include <algorithm>
#include <utility>

#include "emulator_models/plants/machine_tool_plant.hpp"
#include "emulator_models/plants/propulsion_plant.hpp"

namespace emulator_models {
namespace {

using soft_plc::IoDriver;
using soft_plc::OutputGate;
using soft_plc::outputs_bytes_max;

class SimulatedField final : public IoDriver {
 public:
  SimulatedField(std::size_t first_byte, std::vector<std::byte> fixed)
      : first_byte_{first_byte}, fixed_{std::move(fixed)} {}

  bool exchange(const OutputGate::Frame& frame, OutputGate& gate,
                std::span<std::byte> inputs) noexcept override {
    gate.write_through(frame, [this](const OutputGate::Outputs& outputs) { terminals_ = outputs; });
    if (fixed_.empty()) {
      std::copy_n(terminals_.begin() + static_cast<std::ptrdiff_t>(first_byte_), inputs.size(),
                  inputs.begin());
    } else {
      std::ranges::copy(fixed_, inputs.begin());
    }
    return true;
  }

 private:
  const std::size_t first_byte_;
  const std::vector<std::byte> fixed_;  ///< no longer than the driver's section
  OutputGate::Outputs terminals_{};
};

bool bit_of(std::span<const std::byte> bytes, std::size_t index) noexcept {
  return index / 8 < bytes.size() && (bytes[index / 8] >> index % 8 & std::byte{1}) != std::byte{0};
}

template <typename Plant>
class PlantDriver final : public IoDriver {
 public:
  explicit PlantDriver(std::size_t first_byte) : first_byte_{first_byte} {}

  bool exchange(const OutputGate::Frame& frame, OutputGate& gate,
                std::span<std::byte> inputs) noexcept override {
    gate.write_through(frame, [this](const OutputGate::Outputs& outputs) {
      take(std::span{outputs}.subspan(std::min(first_byte_, outputs.size())));
    });
    plant_.advance(terminals_, std::chrono::steady_clock::now());
    give(inputs);
    return true;
  }

 private:
  void take(std::span<const std::byte> outputs) noexcept {
    for (std::size_t i = 0; i < Terminals::points_count; ++i) terminals_.outputs[i] = bit_of(outputs, i);
    for (std::size_t i = 0; i < Terminals::analogs_count; ++i) {
      const std::size_t at = plant_analogs_first_byte + 2 * i;
      if (at + 1 < outputs.size())
        terminals_.analog_outputs[i] = static_cast<std::uint16_t>(
            std::to_integer<unsigned>(outputs[at]) | std::to_integer<unsigned>(outputs[at + 1]) << 8U);
    }
  }

  void give(std::span<std::byte> inputs) const noexcept {
    std::ranges::fill(inputs, std::byte{0});
    for (std::size_t i = 0; i < std::min(Terminals::points_count, inputs.size() * 8); ++i) {
      if (terminals_.inputs[i]) inputs[i / 8] |= static_cast<std::byte>(1U << i % 8);
    }
    for (std::size_t i = 0; i < Terminals::analogs_count; ++i) {
      const std::size_t at = plant_analogs_first_byte + 2 * i;
      if (at + 1 >= inputs.size()) return;
      inputs[at] = static_cast<std::byte>(terminals_.analog_inputs[i] & 0xFFU);
      inputs[at + 1] = static_cast<std::byte>(terminals_.analog_inputs[i] >> 8U);
    }
  }

  const std::size_t first_byte_;
  Terminals terminals_;
  Plant plant_;
};

}  // namespace

std::unique_ptr<IoDriver> make_driver(const soft_plc::ConfiguredDriver& driver) {
  const std::size_t first_byte = driver.config.inputs.first;
  if (driver.kind == "simulated") return std::make_unique<SimulatedField>(first_byte, driver.fixed_inputs);
  if (driver.kind == "machine-tool") return std::make_unique<PlantDriver<MachineToolPlant>>(first_byte);
  if (driver.kind == "propulsion") return std::make_unique<PlantDriver<PropulsionPlant>>(first_byte);
  return nullptr;
}

}  // namespace emulator_models
