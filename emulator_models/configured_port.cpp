#include "emulator_models/configured_port.hpp"

#include <optional>
#include <utility>

namespace emulator_models {
namespace {

using protocol::fx::AddressSpace;
using protocol::fx::Command;
using protocol::fx::Device;
using protocol::fx::DeviceKind;
using protocol::fx::FrameBytes;
using protocol::fx::Model;
using soft_plc::Area;
using soft_plc::Gateway;
using soft_plc::GatewayError;
using soft_plc::GatewayItem;

/// A byte of a cycle's image.
struct Place {
  Area area = Area::memory;
  std::size_t byte = 0;
};

AddressSpace space_of(Command command) noexcept {
  return protocol::fx::is_wide(command) ? AddressSpace::wide : AddressSpace::legacy;
}

FrameBytes single(std::byte answer) noexcept {
  FrameBytes frame;
  frame.push_back(answer);
  return frame;
}

FrameBytes refusal_of(GatewayError error) noexcept {
  return error == GatewayError::timed_out ? FrameBytes{} : single(protocol::fx::nak);
}

/// @param byte_in_device  of a word
std::optional<Place> place_of(Device device, std::size_t byte_in_device) noexcept {
  const std::size_t number = device.number;
  if (device.kind == DeviceKind::x) return Place{Area::inputs, number / 8};
  if (device.kind == DeviceKind::y) return Place{Area::outputs, number / 8};
  if (device.kind == DeviceKind::d && number < ConfiguredPort::data_registers_count)
    return Place{Area::memory, 2 * number + byte_in_device};
  if (device.kind == DeviceKind::m && number < ConfiguredPort::relays_count)
    return Place{Area::memory, ConfiguredPort::relays_first_byte + number / 8};
  return std::nullopt;
}

std::optional<Place> place_of(unsigned address, AddressSpace space) noexcept {
  if (address > 0xFFFFU) return std::nullopt;
  const auto located = protocol::fx::locate_byte(static_cast<std::uint16_t>(address), Model::fx3u, space);
  return located ? place_of(located->device, located->byte_in_device) : std::nullopt;
}

}  // namespace

FrameBytes ConfiguredPort::process(std::span<const std::byte> request) noexcept {
  if (request.size() == 1 && request.front() == protocol::fx::enq) return single(protocol::fx::ack);
  if (const auto transfer = decode_transfer_request(request)) return encode(configuration_.answer(*transfer));
  const auto decoded = protocol::fx::decode_request(request);
  if (!decoded) {
    const bool is_frame = decoded.error() != protocol::fx::FrameError::no_frame &&
                          decoded.error() != protocol::fx::FrameError::too_long;
    return is_frame ? single(protocol::fx::nak) : FrameBytes{};
  }
  switch (decoded->command) {
    case Command::read:
    case Command::read_wide:
    case Command::write:
    case Command::write_wide:
      return read_or_write(*decoded);
    case Command::force_on:
    case Command::force_off:
    case Command::force_on_wide:
    case Command::force_off_wide:
      return force(*decoded);
  }
  return single(protocol::fx::nak);
}

FrameBytes ConfiguredPort::read_or_write(const protocol::fx::Request& request) {
  const bool writes = request.command == Command::write || request.command == Command::write_wide;
  std::vector<GatewayItem> items;
  std::size_t next = 0;
  for (unsigned i = 0; i < request.count_bytes; ++i) {
    const auto place = place_of(request.address + i, space_of(request.command));
    if (!place) return single(protocol::fx::nak);
    if (items.empty() || items.back().area != place->area || next != place->byte)
      items.push_back({.area = place->area, .section = {place->byte, 0}, .written = {}});
    ++items.back().section.bytes;
    if (writes) items.back().written.push_back(request.data[i]);
    next = place->byte + 1;
  }
  const auto answer = ask(std::move(items));
  if (!answer) return refusal_of(answer.error());
  if (writes) return single(protocol::fx::ack);
  protocol::fx::DataBytes bytes;
  for (const auto& read : answer->read) bytes.insert(bytes.end(), read.begin(), read.end());
  return protocol::fx::encode_data_reply(protocol::fx::as_span(bytes));
}

FrameBytes ConfiguredPort::force(const protocol::fx::Request& request) {
  const auto device = protocol::fx::locate_bit(request.address, Model::fx3u, space_of(request.command));
  const auto place = device ? place_of(*device, 0) : std::nullopt;
  if (!place) return single(protocol::fx::nak);
  const bool on = request.command == Command::force_on || request.command == Command::force_on_wide;
  std::vector<GatewayItem> items;
  items.push_back({.area = place->area,
                   .section = {place->byte, 1},
                   .written = {std::byte{on}},
                   .bit = static_cast<std::uint8_t>(device->number % 8)});
  const auto answer = ask(std::move(items));
  return answer ? single(protocol::fx::ack) : refusal_of(answer.error());
}

Gateway::Result ConfiguredPort::ask(std::vector<GatewayItem> items) {
  const auto plc = plc_.plc();
  return plc->gateway().exchange({.cycle = 0, .items = std::move(items)}, plc_.answer_timeout());
}

}  // namespace emulator_models
