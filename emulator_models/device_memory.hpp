// The devices of one PLC and their values; all zero at power-up. A plain value: no lock, no meaning of
// special devices, no rule who may write what (fx_plc_emulator.hpp has these).
//
// The devices lie as the programming port shows them: bits eight to a byte, lowest number in bit 0, words of 2
// bytes and counters from C200 on of 4, low byte first, the special ones of a kind behind the others. So a process
// image is a part of bytes(), and a copy of the memory one memcpy.
//
// Invariants
//   I1  a bit that the model has not is 0, unless who writes through bytes() sets it.
//   I2  where a device lies depends on the model alone, and never changes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
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

  struct Place {
    std::uint32_t byte_index = 0;  ///< in bytes()
    std::uint8_t bit_index = 0;    ///< of a bit device
  };
  /// @param device  one that exists on the model
  [[nodiscard]] Place place_of(protocol::fx::Device device) const noexcept;
  /// The whole memory. The span, and pointers into it, hold until the memory is moved from or destroyed.
  [[nodiscard]] std::span<std::byte> bytes() noexcept { return bytes_; }
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }
  /// X and Y, each from number 0 on, as parts of bytes().
  [[nodiscard]] std::span<std::byte> inputs() noexcept { return part(protocol::fx::DeviceKind::x); }
  [[nodiscard]] std::span<std::byte> outputs() noexcept { return part(protocol::fx::DeviceKind::y); }

  /// Clears devices that are no special ones.
  /// @param count  as many of them as the model has, at most
  void clear(protocol::fx::DeviceKind kind, std::uint16_t first_number, std::uint16_t count) noexcept;

  /// The devices whose values differ, in the order X, Y, M, S, T, C, D.
  [[nodiscard]] std::vector<protocol::fx::Device> differences(const DeviceMemory& other) const;

 private:
  /// Where the devices of one kind begin in bytes_.
  struct Block {
    std::size_t offset = 0;
    std::size_t size_bytes = 0;
    std::uint16_t plain_count = 0;
    std::uint16_t special_count = 0;
  };
  static constexpr std::size_t kinds_count = 9;

  [[nodiscard]] const Block& block(protocol::fx::DeviceKind kind) const noexcept {
    return blocks_[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] std::span<std::byte> part(protocol::fx::DeviceKind kind) noexcept {
    return std::span{bytes_}.subspan(block(kind).offset, block(kind).size_bytes);
  }
  [[nodiscard]] std::uint32_t load(Place place, unsigned width_bits) const noexcept;

  protocol::fx::Model model_;
  std::array<Block, kinds_count> blocks_;
  std::vector<std::byte> bytes_;
};

}  // namespace emulator_models
