#include "emulator_models/fx_address_map.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "emulator_models/soft_plc/il_address.hpp"
#include "emulator_models/special_devices.hpp"
#include "protocol/fx/device_ranges.hpp"

namespace emulator_models {
namespace {

using protocol::fx::Device;
using protocol::fx::DeviceError;
using protocol::fx::DeviceKind;
using protocol::fx::Model;
using soft_plc::Area;
using soft_plc::ElementaryType;
using soft_plc::PlcBlock;
using soft_plc::ValuePlace;
using namespace std::chrono_literals;

constexpr std::uint16_t first_direction_relay = 8200;  ///< M8200: counter C200 counts down
constexpr std::uint16_t first_fast_counter = 235;

bool is_bit(DeviceKind kind) noexcept { return protocol::fx::width_bits({kind, 0}) == 1; }

std::string last_of(DeviceKind kind, unsigned count) {
  return to_string(Device{kind, static_cast<std::uint16_t>(count - 1)});
}

/// "X0 to X17": what the model has of a kind.
std::string range_of(DeviceKind kind, Model model) {
  const protocol::fx::DeviceRanges ranges = protocol::fx::ranges_of(model);
  const std::string special = std::to_string(8000 + ranges.special - 1);
  switch (kind) {
    case DeviceKind::x:
      return "X0 to " + last_of(kind, ranges.x);
    case DeviceKind::y:
      return "Y0 to " + last_of(kind, ranges.y);
    case DeviceKind::m:
      return "M0 to " + last_of(kind, ranges.m) + " and M8000 to M" + special;
    case DeviceKind::s:
      return "S0 to " + last_of(kind, ranges.s);
    case DeviceKind::d:
      return "D0 to " + last_of(kind, ranges.d) + " and D8000 to D" + special;
    case DeviceKind::t_contact:
    case DeviceKind::t_value:
      return "T0 to T" + std::to_string(ranges.t - 1);
    case DeviceKind::c_contact:
    case DeviceKind::c_value:
      return model == Model::fx1s ? "C0 to C31" : "C0 to C234";
  }
  return {};
}

std::string model_has(DeviceKind kind, Model model) {
  return std::string{to_string(model)} + " has " + range_of(kind, model);
}

std::chrono::milliseconds unit_of_timer(std::uint16_t number) noexcept {
  if (number >= 256) return 1ms;  // FX3U only
  if (number >= 250 || number < 200) return 100ms;
  return number >= 246 ? 1ms : 10ms;
}

bool is_retentive_timer(std::uint16_t number) noexcept { return number >= 246 && number <= 255; }

/// Digits after the first letter; nothing when other characters are among them.
std::optional<unsigned> number_after_letter(std::string_view name) noexcept {
  if (name.size() < 2) return std::nullopt;
  unsigned number = 0;
  for (const char c : name.substr(1)) {
    if (c < '0' || c > '9') return std::nullopt;
    number = std::min(number * 10 + static_cast<unsigned>(c - '0'), 0xFFFFU);
  }
  return number;
}

}  // namespace

FxAddressMap::Place FxAddressMap::place_of(Device device, ElementaryType type) const {
  const Model model = layout_.model();
  const auto wrong = [&](const std::string& why) { return tl::unexpected(to_string(device) + " " + why); };
  if (is_bit(device.kind) != (type == ElementaryType::boolean))
    return wrong(is_bit(device.kind) ? "is a bit and takes a BOOL"
                                     : "is a register of 16 bits and takes INT, WORD or a longer type");
  const std::size_t size = soft_plc::size_bytes(type);
  if (!is_bit(device.kind) && size < 2) return wrong("has 16 bits: take INT, UINT or WORD");
  const std::size_t devices_count = is_bit(device.kind) ? 1 : size / 2;
  std::string_view read_only_as = device.kind == DeviceKind::x ? "a physical input" : "";
  for (std::size_t i = 0; i < devices_count; ++i) {
    const std::size_t number = device.number + i;
    const Device part{device.kind, static_cast<std::uint16_t>(number)};
    const bool leaves_its_range =
        device.number < protocol::fx::first_special_number && number >= protocol::fx::first_special_number;
    if (leaves_its_range || number > std::numeric_limits<std::uint16_t>::max() || !exists(part, model))
      return wrong(
          (i == 0 ? "does not exist: " : "and the registers behind it that the type takes do not exist: ") +
          model_has(device.kind, model));
    if (is_read_only(part, model)) read_only_as = "a special device that the PLC itself writes";
  }
  const DeviceMemory::Place place = layout_.place_of(device);
  // X and Y are images of their own, which begin with their first device.
  const auto relative = [&](DeviceKind kind) {
    return place.byte_index - layout_.place_of({kind, 0}).byte_index;
  };
  if (device.kind == DeviceKind::x)
    return ValuePlace{type, Area::inputs, relative(DeviceKind::x), place.bit_index, read_only_as};
  if (device.kind == DeviceKind::y)
    return ValuePlace{type, Area::outputs, relative(DeviceKind::y), place.bit_index, read_only_as};
  return ValuePlace{type, Area::memory, place.byte_index, place.bit_index, read_only_as};
}

FxAddressMap::Place FxAddressMap::bit_string(Area area, std::size_t byte_index, ElementaryType type) const {
  const DeviceKind kind = area == Area::inputs ? DeviceKind::x : DeviceKind::y;
  const auto ranges = protocol::fx::ranges_of(layout_.model());
  const std::size_t devices_count = area == Area::inputs ? ranges.x : ranges.y;
  if (byte_index + soft_plc::size_bytes(type) > devices_count / 8)
    return tl::unexpected("this address has not all its bits: " + model_has(kind, layout_.model()));
  return ValuePlace{type, area, static_cast<std::uint32_t>(byte_index), 0,
                    area == Area::inputs ? "a physical input" : ""};
}

FxAddressMap::Place FxAddressMap::address(std::string_view text) const {
  const auto parsed = soft_plc::parse_address(text);
  if (!parsed) return tl::unexpected(parsed.error());
  const bool bit = parsed->type == ElementaryType::boolean;
  if (!bit && parsed->area != Area::memory) return bit_string(parsed->area, parsed->byte_index, parsed->type);
  DeviceKind kind = DeviceKind::d;
  std::size_t number = parsed->byte_index / 2;
  if (bit) {
    kind = parsed->area == Area::inputs    ? DeviceKind::x
           : parsed->area == Area::outputs ? DeviceKind::y
                                           : DeviceKind::m;
    number = std::size_t{parsed->byte_index} * 8 + parsed->bit_index;
  } else if (parsed->type == ElementaryType::byte) {
    return tl::unexpected(std::string{text} +
                          ": on an FX, %M has bits (%MX, the M) and words (%MW, the D), no bytes");
  }
  if (number > std::numeric_limits<std::uint16_t>::max())
    return tl::unexpected(std::string{text} + " does not exist: " + model_has(kind, layout_.model()));
  const auto place = place_of({kind, static_cast<std::uint16_t>(number)}, parsed->type);
  if (!place) return tl::unexpected(std::string{text} + ": " + place.error());
  return place;
}

FxAddressMap::Place FxAddressMap::device(std::string_view upper_name, ElementaryType type) const {
  const std::string name{upper_name};
  if (name.front() == 'T' || name.front() == 'C')
    return tl::unexpected(name + ": nothing lies AT a timer or counter; use its outputs, as T5.Q and T5.CV");
  const auto device = protocol::fx::parse_device(upper_name, layout_.model());
  if (device) return place_of(*device, type);
  switch (device.error()) {
    case DeviceError::not_a_device:
      return tl::unexpected(
          name + " is no device: AT is followed by X5, Y12, M120, S5, D100 or an address as %IX0.0");
    case DeviceError::not_octal:
      return tl::unexpected(name + ": " + std::string{to_string(device.error())});
    case DeviceError::out_of_range:
      break;
  }
  constexpr std::array kinds{DeviceKind::x, DeviceKind::y, DeviceKind::m, DeviceKind::s, DeviceKind::d};
  const auto kind = static_cast<std::size_t>(std::string_view{"XYMSD"}.find(name.front()));
  return tl::unexpected(name + " does not exist: " + model_has(kinds[kind], layout_.model()));
}

std::optional<FxAddressMap::Place> FxAddressMap::undeclared(std::string_view upper_name) const {
  if (upper_name.empty() || std::string_view{"XYMSD"}.find(upper_name.front()) == std::string_view::npos ||
      !number_after_letter(upper_name))
    return std::nullopt;
  return device(upper_name, upper_name.front() == 'D' ? ElementaryType::int_ : ElementaryType::boolean);
}

std::optional<tl::expected<PlcBlock, std::string>> FxAddressMap::block(std::string_view upper_name) const {
  if (upper_name.empty() || (upper_name.front() != 'T' && upper_name.front() != 'C')) return std::nullopt;
  const auto digits = number_after_letter(upper_name);
  if (!digits) return std::nullopt;
  const bool timer = upper_name.front() == 'T';
  const auto number = static_cast<std::uint16_t>(*digits);
  const Device contact{timer ? DeviceKind::t_contact : DeviceKind::c_contact, number};
  if (!exists(contact, layout_.model()))
    return tl::unexpected(std::string{upper_name} +
                          " does not exist: " + model_has(contact.kind, layout_.model()));
  if (!timer && number >= first_fast_counter)
    return tl::unexpected(
        std::string{upper_name} +
        " is a high-speed counter, which counts terminals and which this PLC has not: take " +
        range_of(contact.kind, layout_.model()));
  const auto bit = [this](Device device) {
    const DeviceMemory::Place place = layout_.place_of(device);
    return soft_plc::BitDevice{place.byte_index, place.bit_index};
  };
  PlcBlock found;
  found.devices.contact = bit(contact);
  found.devices.value_byte_index =
      layout_.place_of({timer ? DeviceKind::t_value : DeviceKind::c_value, number}).byte_index;
  if (timer) {
    found.kind = is_retentive_timer(number) ? soft_plc::BlockKind::retentive_device_timer
                                            : soft_plc::BlockKind::device_timer;
    found.devices.unit = unit_of_timer(number);
  } else if (number < protocol::fx::first_wide_counter) {
    found.kind = soft_plc::BlockKind::device_counter;
  } else {
    found.kind = soft_plc::BlockKind::wide_device_counter;
    const auto relay =
        static_cast<std::uint16_t>(first_direction_relay + number - protocol::fx::first_wide_counter);
    found.devices.counts_down = bit({DeviceKind::m, relay});
  }
  return found;
}

}  // namespace emulator_models
