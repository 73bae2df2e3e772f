#include "emulator_models/device_memory.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "protocol/check.hpp"
#include "protocol/fx/device_ranges.hpp"

namespace emulator_models {
namespace {

using protocol::fx::AddressSpace;
using protocol::fx::ByteLocation;
using protocol::fx::Device;
using protocol::fx::DeviceKind;
using protocol::fx::Model;

static_assert(std::endian::native == std::endian::little, "words are copied, not assembled byte by byte");

/// Bytes that `count` devices of a kind from number 0 on take.
std::size_t bytes_of(DeviceKind kind, std::size_t count) noexcept {
  constexpr std::size_t narrow_counters_count = protocol::fx::first_wide_counter;
  switch (protocol::fx::width_bits_of({kind, 0})) {
    case 1:
      return (count + 7) / 8;
    default:
      if (kind == DeviceKind::c_value && count > narrow_counters_count)
        return 2 * narrow_counters_count + 4 * (count - narrow_counters_count);
      return 2 * count;
  }
}

Device neighbour(Device first, unsigned index) noexcept {
  return {first.kind, static_cast<std::uint16_t>(first.number + index)};
}

}  // namespace

DeviceMemory::DeviceMemory(protocol::fx::Model model) : model_{model} {
  const protocol::fx::DeviceRanges ranges = protocol::fx::ranges_of(model);
  std::size_t offset = 0;
  const auto place = [&](DeviceKind kind, std::uint16_t plain_count, std::uint16_t special_count) {
    const std::size_t size = bytes_of(kind, std::size_t{plain_count} + special_count);
    blocks_[static_cast<std::size_t>(kind)] = {offset, size, plain_count, special_count};
    offset += size;
  };
  place(DeviceKind::x, ranges.x, 0);
  place(DeviceKind::y, ranges.y, 0);
  place(DeviceKind::m, ranges.m, ranges.special);
  place(DeviceKind::s, ranges.s, 0);
  place(DeviceKind::t_contact, ranges.t, 0);
  place(DeviceKind::c_contact, ranges.c, 0);
  place(DeviceKind::t_value, ranges.t, 0);
  place(DeviceKind::c_value, ranges.c, 0);
  place(DeviceKind::d, ranges.d, ranges.special);
  bytes_.resize(offset);
}

DeviceMemory::Place DeviceMemory::place_of(Device device) const noexcept {
  const Block& home = block(device.kind);
  const unsigned special_index = unsigned{device.number} - protocol::fx::first_special_number;
  const bool is_plain = device.number < home.plain_count;
  PLC_CHECK(is_plain || special_index < home.special_count);
  // The only gap within a block: the counters of an FX1S.
  PLC_CHECK(model_ != Model::fx1s || protocol::fx::exists(device, model_));
  const std::size_t index = is_plain ? device.number : std::size_t{home.plain_count} + special_index;
  if (protocol::fx::width_bits_of(device) == 1)
    return {static_cast<std::uint32_t>(home.offset + index / 8), static_cast<std::uint8_t>(index % 8)};
  return {static_cast<std::uint32_t>(home.offset + bytes_of(device.kind, index)), 0};
}

std::uint32_t DeviceMemory::load(Place place, unsigned width_bits) const noexcept {
  const std::byte* const from = bytes_.data() + place.byte_index;
  if (width_bits == 1) return std::to_integer<std::uint32_t>(*from) >> place.bit_index & 1U;
  std::uint32_t value = 0;
  std::memcpy(&value, from, width_bits / 8);
  return value;
}

std::uint32_t DeviceMemory::get(Device device) const noexcept {
  return load(place_of(device), protocol::fx::width_bits_of(device));
}

void DeviceMemory::set(Device device, std::uint32_t value) noexcept {
  const Place place = place_of(device);
  const unsigned width = protocol::fx::width_bits_of(device);
  std::byte* const to = bytes_.data() + place.byte_index;
  if (width == 1) {
    const std::byte bit = std::byte{1} << place.bit_index;
    *to = value != 0 ? *to | bit : *to & ~bit;
  } else {
    std::memcpy(to, &value, width / 8);
  }
}

std::optional<std::byte> DeviceMemory::read_byte(std::uint16_t address, AddressSpace space) const noexcept {
  const auto place = protocol::fx::locate_byte(address, model_, space);
  if (!place) return std::nullopt;
  if (protocol::fx::width_bits_of(place->device) != 1)
    return static_cast<std::byte>(get(place->device) >> (8U * place->byte_in_device));
  unsigned byte = 0;
  for (unsigned bit = 0; bit < 8; ++bit) {
    const Device device = neighbour(place->device, bit);
    if (protocol::fx::exists(device, model_)) byte |= get(device) << bit;
  }
  return static_cast<std::byte>(byte);
}

bool DeviceMemory::write_byte(std::uint16_t address, AddressSpace space, std::byte value) noexcept {
  const auto place = protocol::fx::locate_byte(address, model_, space);
  if (!place) return false;
  const std::uint32_t byte = std::to_integer<std::uint32_t>(value);
  if (protocol::fx::width_bits_of(place->device) != 1) {
    const unsigned shift = 8U * place->byte_in_device;
    set(place->device, (get(place->device) & ~(0xFFU << shift)) | byte << shift);
    return true;
  }
  for (unsigned bit = 0; bit < 8; ++bit) {
    const Device device = neighbour(place->device, bit);
    if (protocol::fx::exists(device, model_)) set(device, byte >> bit & 1U);
  }
  return true;
}

void DeviceMemory::clear(DeviceKind kind, std::uint16_t first_number, std::uint16_t count) noexcept {
  const unsigned end = std::min(unsigned{first_number} + count, unsigned{block(kind).plain_count});
  for (unsigned number = first_number; number < end; ++number) {
    const Device device{kind, static_cast<std::uint16_t>(number)};
    if (protocol::fx::exists(device, model_)) set(device, 0);
  }
}

std::vector<Device> DeviceMemory::differences(const DeviceMemory& other) const {
  PLC_CHECK(other.model_ == model_);
  std::vector<Device> changed;
  for (std::size_t i = 0; i < kinds_count; ++i) {
    const auto kind = static_cast<DeviceKind>(i);
    const Block& home = blocks_[i];
    if (std::memcmp(bytes_.data() + home.offset, other.bytes_.data() + home.offset, home.size_bytes) == 0)
      continue;
    const auto look_at = [&](unsigned number) {
      const Device device{kind, static_cast<std::uint16_t>(number)};
      if (protocol::fx::exists(device, model_) && get(device) != other.get(device)) changed.push_back(device);
    };
    for (unsigned number = 0; number < home.plain_count; ++number) look_at(number);
    for (unsigned k = 0; k < home.special_count; ++k) look_at(protocol::fx::first_special_number + k);
  }
  return changed;
}

}  // namespace emulator_models
