// The FX programming port of a configured soft PLC: frames are answered through the gateway, by the first cycle of the
// configuration, in phase 1 of its next scan. So FX tools and the kernel's client can look at a PLC that is no FX.
//
//   X n, Y n        bit n of %I, of %Q: X10 is %IX1.0. Read only; Y as this cycle has set it
//   D0 to D7999     %MW of the same number
//   M0 to M3071     bit n from %MX16000.0 on, after the last D
//   all others      there is none: NAK. T, C and S, too: timers and counters of a program in IEC 61131-3 are instances
//                   without an address, steps are variables as it likes; who wants them outside gives them a %M
//
// Device addresses are those of an FX3U. A request of many devices sees one image; a write happens whole or not at all.
// What the gateway refuses (words that other cycles send, a full queue) is answered NAK; a request that no scan serves
// in answer_timeout_ms is met with silence, and not carried out later.
//
// The messages of configuration_frames.hpp are answered, too, between FX frames: no FX tool sends them.
#pragma once

#include "emulator_models/configuration_service.hpp"
#include "emulator_models/i_plc_emulator.hpp"
#include "emulator_models/soft_plc/configured_plc.hpp"
#include "protocol/fx/address_map.hpp"

namespace emulator_models {

class ConfiguredPort final : public IPlcEmulator {
 public:
  static constexpr std::uint16_t data_registers_count = 8000;
  static constexpr std::uint16_t relays_count = 3072;
  /// Of %M.
  static constexpr std::size_t relays_first_byte = 2 * data_registers_count;

  /// @param plc            with a configuration; must outlive the port
  /// @param configuration  takes another one; must outlive the port
  ConfiguredPort(soft_plc::ConfiguredPlc& plc, ConfigurationService& configuration) noexcept
      : plc_{plc}, configuration_{configuration} {}

  [[nodiscard]] protocol::fx::FrameBytes process(std::span<const std::byte> request) noexcept override;

 private:
  [[nodiscard]] protocol::fx::FrameBytes read_or_write(const protocol::fx::Request& request);
  [[nodiscard]] protocol::fx::FrameBytes force(const protocol::fx::Request& request);
  [[nodiscard]] soft_plc::Gateway::Result ask(std::vector<soft_plc::GatewayItem> items);

  soft_plc::ConfiguredPlc& plc_;
  ConfigurationService& configuration_;
};

}  // namespace emulator_models
