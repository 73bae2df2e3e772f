#include "emulator_models/device_memory.hpp"

#include <algorithm>

#include "protocol/check.hpp"
#include "protocol/fx/device_ranges.hpp"

namespace emulator_models {
namespace {

using protocol::fx::AddressSpace;
using protocol::fx::ByteLocation;
using protocol::fx::Device;
using protocol::fx::DeviceKind;

constexpr std::uint32_t value_mask(unsigned width_bits) noexcept {
  return width_bits == 32 ? 0xFFFF'FFFFU : (1U << width_bits) - 1U;
}

Device neighbour(Device first, unsigned index) noexcept {
  return {first.kind, static_cast<std::uint16_t>(first.number + index)};
}

}  // namespace

DeviceMemory::DeviceMemory(protocol::fx::Model model) : model_{model} {
  const protocol::fx::DeviceRanges ranges = protocol::fx::ranges_of(model);
  std::size_t offset = 0;
  const auto place = [&](DeviceKind kind, std::uint16_t plain_count, std::uint16_t special_count) {
    blocks_[static_cast<std::size_t>(kind)] = {offset, plain_count, special_count};
    offset += std::size_t{plain_count} + special_count;
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
  values_.resize(offset);
}

std::size_t DeviceMemory::index_of(Device device) const noexcept {
  PLC_CHECK(protocol::fx::exists(device, model_));
  const Block& home = block(device.kind);
  if (device.number < home.plain_count) return home.offset + device.number;
  return home.offset + home.plain_count + device.number - protocol::fx::first_special_number;
}

std::uint32_t DeviceMemory::get(Device device) const noexcept { return values_[index_of(device)]; }

void DeviceMemory::set(Device device, std::uint32_t value) noexcept {
  const unsigned width = protocol::fx::width_bits(device);
  values_[index_of(device)] = width == 1 ? value != 0 : value & value_mask(width);
}

std::optional<std::byte> DeviceMemory::read_byte(std::uint16_t address, AddressSpace space) const noexcept {
  const auto place = protocol::fx::locate_byte(address, model_, space);
  if (!place) return std::nullopt;
  if (protocol::fx::width_bits(place->device) != 1)
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
  if (protocol::fx::width_bits(place->device) != 1) {
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

void DeviceMemory::clear_not_latched() noexcept {
  for (const DeviceKind kind : {DeviceKind::y, DeviceKind::m, DeviceKind::t_contact, DeviceKind::c_contact,
                                DeviceKind::t_value, DeviceKind::c_value}) {
    const auto begin = values_.begin() + static_cast<std::ptrdiff_t>(block(kind).offset);
    std::fill(begin, begin + block(kind).plain_count, 0U);
  }
}

std::vector<Device> DeviceMemory::differences(const DeviceMemory& other) const {
  PLC_CHECK(other.model_ == model_);
  std::vector<Device> changed;
  for (std::size_t kind = 0; kind < kinds_count; ++kind) {
    const Block& home = blocks_[kind];
    for (std::size_t i = 0; i < home.size(); ++i) {
      if (values_[home.offset + i] == other.values_[home.offset + i]) continue;
      const std::size_t number =
          i < home.plain_count ? i : i - home.plain_count + protocol::fx::first_special_number;
      changed.push_back({static_cast<DeviceKind>(kind), static_cast<std::uint16_t>(number)});
    }
  }
  return changed;
}

}  // namespace emulator_models
