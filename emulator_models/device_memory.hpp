// The devices of one PLC and their values; all zero at power-up. A plain value: no lock, no meaning of
// special devices, no rule who may write what (fx_plc_emulator.hpp has these).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/fx/address_map.hpp"

namespace emulator_models {

class DeviceMemory {
 public:
  explicit DeviceMemory(protocol::fx::Model model);

  [[nodiscard]] protocol::fx::Model model() const noexcept { return model_; }

  /// @param device  one that exists on the model; anything else is a mistake of the caller (PLC_CHECK)
  /// @return        0 or 1 for a bit; 16 bits for a word; 32 for a counter from C200 on
  [[nodiscard]] std::uint32_t get(protocol::fx::Device device) const noexcept;
  /// @param value  of a bit device, whether it is on; of the others, what fits their width
  void set(protocol::fx::Device device, std::uint32_t value) noexcept;

  /// One byte of an address space. Bits that do not exist on the model read as 0 and ignore a write.
  /// @return nothing where no device lies
  [[nodiscard]] std::optional<std::byte> read_byte(std::uint16_t address,
                                                   protocol::fx::AddressSpace space) const noexcept;
  /// @return whether a device lies there
  bool write_byte(std::uint16_t address, protocol::fx::AddressSpace space, std::byte value) noexcept;

  /// What happens to the memory when the PLC goes from STOP to RUN: Y, T, C and the M below 8000 are cleared.
  void clear_not_latched() noexcept;

  /// The devices whose values differ, in the order X, Y, M, S, T, C, D.
  [[nodiscard]] std::vector<protocol::fx::Device> differences(const DeviceMemory& other) const;

 private:
  /// Where the devices of one kind lie in values_: those from 0 on, then the special ones.
  struct Block {
    std::size_t offset = 0;
    std::uint16_t plain_count = 0;
    std::uint16_t special_count = 0;

    [[nodiscard]] std::size_t size() const noexcept { return std::size_t{plain_count} + special_count; }
  };
  static constexpr std::size_t kinds_count = 9;

  [[nodiscard]] const Block& block(protocol::fx::DeviceKind kind) const noexcept {
    return blocks_[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] std::size_t index_of(protocol::fx::Device device) const noexcept;

  protocol::fx::Model model_;
  std::array<Block, kinds_count> blocks_;
  /// One element a device. Bits could be packed; a PLC of 23,000 devices takes 92 kB this way, which is
  /// little and keeps every access a plain load.
  std::vector<std::uint32_t> values_;
};

}  // namespace emulator_models
