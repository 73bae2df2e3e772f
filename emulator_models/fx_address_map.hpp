// What instruction list sees of an FX PLC: its devices, where they lie in DeviceMemory.
//
//   x AT X5 : BOOL          X, Y (octal), M, S: BOOL
//   x AT D100 : DINT        D: as many registers from there on as the type is long, low word first
//   LD X5, ST D100          the same without a declaration: BOOL, and INT for D. A declared name hides the device
//   CAL T5(IN := x, PV := 50)   T, C: blocks that are there by themselves (device_blocks.hpp); outputs T5.Q, T5.CV
//   %IXb.n, %QXb.n, %MXb.n  X, Y and M of index 8b + n; %IB, %IW, ... the same X and Y as bit strings
//   %MW k, %MD k, %ML k     D k; D 2k and on; D 4k and on: apart from %MX
//
// The process image: inputs = DeviceMemory::inputs(), outputs = outputs(), memory = bytes().
#pragma once

#include "emulator_models/device_memory.hpp"
#include "emulator_models/soft_plc/il_address_map.hpp"

namespace emulator_models {

class FxAddressMap final : public soft_plc::AddressMap {
 public:
  explicit FxAddressMap(protocol::fx::Model model) : layout_{model} {}

  [[nodiscard]] tl::expected<soft_plc::ValuePlace, std::string> address(std::string_view text) const override;
  [[nodiscard]] tl::expected<soft_plc::ValuePlace, std::string> device(
      std::string_view upper_name, soft_plc::ElementaryType type) const override;
  [[nodiscard]] std::optional<tl::expected<soft_plc::ValuePlace, std::string>> undeclared(
      std::string_view upper_name) const override;
  [[nodiscard]] std::optional<tl::expected<soft_plc::PlcBlock, std::string>> block(
      std::string_view upper_name) const override;

 private:
  using Place = tl::expected<soft_plc::ValuePlace, std::string>;

  [[nodiscard]] Place place_of(protocol::fx::Device device, soft_plc::ElementaryType type) const;
  [[nodiscard]] Place bit_string(soft_plc::Area area, std::size_t byte_index,
                                 soft_plc::ElementaryType type) const;

  DeviceMemory layout_;  ///< asked only where devices lie
};

}  // namespace emulator_models
