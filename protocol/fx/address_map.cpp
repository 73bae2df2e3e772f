#include "protocol/fx/address_map.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "protocol/fx/device_ranges.hpp"

namespace protocol::fx {
namespace {

/// Devices of one kind that lie side by side. A model may have only some of them: device_ranges.hpp.
struct Area {
  DeviceKind kind;
  std::uint16_t first_number;
  std::uint16_t devices_count;
  std::uint16_t byte_address;

  [[nodiscard]] constexpr Device device(unsigned index) const noexcept {
    return {kind, static_cast<std::uint16_t>(first_number + index)};
  }
  [[nodiscard]] constexpr bool holds(Device wanted) const noexcept {
    return wanted.kind == kind && wanted.number >= first_number &&
           wanted.number - first_number < devices_count;
  }
  [[nodiscard]] constexpr unsigned device_bits() const noexcept { return width_bits_of(device(0)); }
  [[nodiscard]] constexpr unsigned size_bytes() const noexcept {
    return (devices_count * device_bits() + 7U) / 8U;
  }
};

using enum DeviceKind;

/// Commands 0, 1, 7 and 8, all models. Left out: the second and third image (coils and resets of timers and
/// counters, mirrors of Y and M), which two libraries use and the clone that was captured refuses.
constexpr std::array legacy_areas{
    Area{s, 0, 1000, 0x0000},        Area{x, 0, 256, 0x0080},       Area{y, 0, 256, 0x00A0},
    Area{t_contact, 0, 256, 0x00C0}, Area{m, 0, 1536, 0x0100},      Area{c_contact, 0, 256, 0x01C0},
    Area{m, 8000, 256, 0x01E0},      Area{t_value, 0, 256, 0x0800}, Area{c_value, 0, 200, 0x0A00},
    Area{c_value, 200, 56, 0x0C00},  Area{d, 8000, 256, 0x0E00},    Area{d, 0, 8000, 0x1000},
};

/// E commands of FX1N and FX2N: what captures and one firmware show. Where D, S and the contacts lie is not
/// known, so they are not shown here; the legacy space has them.
constexpr std::array wide_areas_fx1n{
    Area{m, 0, 3072, 0x0000},   Area{y, 0, 256, 0x0180},       Area{m, 8000, 256, 0x01C0},
    Area{x, 0, 256, 0x0240},    Area{c_value, 0, 200, 0x0A00}, Area{c_value, 200, 56, 0x0C00},
    Area{d, 8000, 256, 0x0E00}, Area{t_value, 0, 256, 0x1000},
};

/// E commands of FX3U. Left out: the coils of counters (92E0H) and timers (9300H), no devices of their own.
constexpr std::array wide_areas_fx3u{
    Area{c_value, 0, 200, 0x0A00}, Area{c_value, 200, 56, 0x0C00},  Area{t_value, 0, 512, 0x1000},
    Area{d, 0, 8000, 0x4000},      Area{d, 8000, 512, 0x8000},      Area{m, 0, 7680, 0x8800},
    Area{y, 0, 256, 0x8BC0},       Area{m, 8000, 512, 0x8C00},      Area{x, 0, 256, 0x8CA0},
    Area{s, 0, 4096, 0x8CE0},      Area{c_contact, 0, 256, 0x9340}, Area{t_contact, 0, 512, 0x9360},
};

std::span<const Area> areas_of(Model model, AddressSpace space) noexcept {
  if (space == AddressSpace::legacy) return legacy_areas;
  switch (model) {
    case Model::fx1s:
      return {};  // has no E commands
    case Model::fx1n:
    case Model::fx2n:
      return wide_areas_fx1n;
    case Model::fx3u:
      return wide_areas_fx3u;
  }
  return {};
}

/// Where bit 0 of a byte lies among the bit numbers of a force command. In the legacy space no bit device
/// lies at 8000H or above, so that one rule serves both spaces.
constexpr unsigned bit_number_of(unsigned byte_address) noexcept { return 8U * (byte_address % 0x8000U); }

const Area* find_area(Device device, Model model, AddressSpace space) noexcept {
  if (!exists(device, model)) return nullptr;
  for (const Area& area : areas_of(model, space))
    if (area.holds(device)) return &area;
  return nullptr;
}

}  // namespace

std::optional<std::uint16_t> byte_address(Device device, Model model, AddressSpace space) noexcept {
  const Area* const area = find_area(device, model, space);
  if (area == nullptr) return std::nullopt;
  const unsigned offset_bits = (device.number - unsigned{area->first_number}) * area->device_bits();
  return static_cast<std::uint16_t>(area->byte_address + offset_bits / 8U);
}

std::optional<std::uint16_t> bit_number(Device device, Model model, AddressSpace space) noexcept {
  const Area* const area = find_area(device, model, space);
  if (area == nullptr || area->device_bits() != 1) return std::nullopt;
  return static_cast<std::uint16_t>(bit_number_of(area->byte_address) + device.number - area->first_number);
}

std::optional<ByteLocation> locate_byte(std::uint16_t address, Model model, AddressSpace space) noexcept {
  for (const Area& area : areas_of(model, space)) {
    if (address < area.byte_address || address - area.byte_address >= static_cast<int>(area.size_bytes()))
      continue;
    const unsigned offset_bytes = address - unsigned{area.byte_address};
    if (area.device_bits() != 1) {
      const unsigned device_bytes = area.device_bits() / 8U;
      const Device word = area.device(offset_bytes / device_bytes);
      if (!exists(word, model)) return std::nullopt;
      return ByteLocation{word, static_cast<std::uint8_t>(offset_bytes % device_bytes), 1};
    }
    const unsigned first_index = 8U * offset_bytes;
    const unsigned end_index = std::min(first_index + 8U, unsigned{area.devices_count});
    std::uint8_t existing = 0;
    for (unsigned index = first_index; index < end_index; ++index)
      if (exists(area.device(index), model)) ++existing;
    if (existing == 0) return std::nullopt;
    return ByteLocation{area.device(first_index), 0, existing};
  }
  return std::nullopt;
}

std::optional<Device> locate_bit(std::uint16_t bit_number, Model model, AddressSpace space) noexcept {
  for (const Area& area : areas_of(model, space)) {
    const unsigned first = bit_number_of(area.byte_address);
    if (area.device_bits() != 1 || bit_number < first || bit_number - first >= area.devices_count) continue;
    const Device device = area.device(bit_number - first);
    if (!exists(device, model)) return std::nullopt;
    return device;
  }
  return std::nullopt;
}

}  // namespace protocol::fx
