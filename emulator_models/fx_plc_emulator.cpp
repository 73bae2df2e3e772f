#include "emulator_models/fx_plc_emulator.hpp"

#include <optional>

namespace emulator_models {
namespace {

using protocol::fx::AddressSpace;
using protocol::fx::Command;
using protocol::fx::FrameBytes;
using protocol::fx::FrameError;
using protocol::fx::Request;

AddressSpace space_of(Command command) noexcept {
  return protocol::fx::is_wide(command) ? AddressSpace::wide : AddressSpace::legacy;
}

FrameBytes single(std::byte answer) noexcept {
  FrameBytes frame;
  frame.push_back(answer);
  return frame;
}

/// @return what D8062 says of a defect; nothing when no whole frame came, which a PLC does not notice
std::optional<PortTrouble> trouble_of(FrameError error) noexcept {
  switch (error) {
    case FrameError::no_frame:
    case FrameError::too_long:
      return std::nullopt;
    case FrameError::bad_checksum:
      return PortTrouble::bad_checksum;
    case FrameError::unknown_command:
      return PortTrouble::bad_command;
    case FrameError::bad_digit:
      return PortTrouble::bad_character;
    case FrameError::bad_length:
    case FrameError::bad_count:
      return PortTrouble::bad_format;
  }
  return std::nullopt;
}

/// The address of byte `index` of a request.
/// @return nothing beyond FFFFH
std::optional<std::uint16_t> nth_address(const Request& request, unsigned index) noexcept {
  const unsigned address = request.address + index;
  if (address > 0xFFFFU) return std::nullopt;
  return static_cast<std::uint16_t>(address);
}

bool may_be_written(std::uint16_t address, protocol::fx::Model model, AddressSpace space) noexcept {
  const auto place = protocol::fx::locate_byte(address, model, space);
  if (!place) return false;
  const unsigned devices_in_byte = protocol::fx::width_bits(place->device) == 1 ? 8 : 1;
  for (unsigned i = 0; i < devices_in_byte; ++i)
    if (is_read_only({place->device.kind, static_cast<std::uint16_t>(place->device.number + i)}, model))
      return false;
  return true;
}

}  // namespace

FxPlcEmulator::FxPlcEmulator(protocol::fx::Model model) : memory_{model} { set_power_up_values(memory_); }

FrameBytes FxPlcEmulator::process(std::span<const std::byte> request) noexcept {
  const std::lock_guard lock{mutex_};
  return process_locked(request);
}

FrameBytes FxPlcEmulator::process(std::span<const std::byte> request, const LockedMemory&) noexcept {
  return process_locked(request);
}

FrameBytes FxPlcEmulator::process_locked(std::span<const std::byte> request) noexcept {
  if (request.size() == 1 && request.front() == protocol::fx::enq) return single(protocol::fx::ack);
  const auto decoded = protocol::fx::decode_request(request);
  if (decoded) return execute(*decoded);
  const auto trouble = trouble_of(decoded.error());
  return trouble ? refuse(*trouble) : FrameBytes{};
}

FrameBytes FxPlcEmulator::execute(const Request& request) noexcept {
  switch (request.command) {
    case Command::read:
    case Command::read_wide:
      return read(request);
    case Command::write:
    case Command::write_wide:
      return write(request);
    case Command::force_on:
    case Command::force_off:
    case Command::force_on_wide:
    case Command::force_off_wide:
      return force(request);
  }
  return refuse(PortTrouble::bad_command);
}

FrameBytes FxPlcEmulator::read(const Request& request) noexcept {
  protocol::fx::DataBytes bytes;
  for (unsigned i = 0; i < request.count_bytes; ++i) {
    const auto address = nth_address(request, i);
    const auto byte = address ? memory_.read_byte(*address, space_of(request.command)) : std::nullopt;
    if (!byte) return refuse(PortTrouble::bad_command);
    bytes.push_back(*byte);
  }
  return protocol::fx::encode_data_reply(protocol::fx::as_span(bytes));
}

FrameBytes FxPlcEmulator::write(const Request& request) noexcept {
  const AddressSpace space = space_of(request.command);
  // All or nothing: the whole range is looked at before its first byte is written.
  for (unsigned i = 0; i < request.count_bytes; ++i) {
    const auto address = nth_address(request, i);
    if (!address || !may_be_written(*address, memory_.model(), space))
      return refuse(PortTrouble::bad_command);
  }
  for (unsigned i = 0; i < request.count_bytes; ++i)
    memory_.write_byte(static_cast<std::uint16_t>(request.address + i), space, request.data[i]);
  return single(protocol::fx::ack);
}

FrameBytes FxPlcEmulator::force(const Request& request) noexcept {
  const auto device = protocol::fx::locate_bit(request.address, memory_.model(), space_of(request.command));
  if (!device || is_read_only(*device, memory_.model())) return refuse(PortTrouble::bad_command);
  memory_.set(*device, request.command == Command::force_on || request.command == Command::force_on_wide);
  return single(protocol::fx::ack);
}

FrameBytes FxPlcEmulator::refuse(PortTrouble trouble) noexcept {
  note_port_trouble(memory_, trouble);
  return single(protocol::fx::nak);
}

DeviceMemory FxPlcEmulator::snapshot() const {
  const std::lock_guard lock{mutex_};
  return memory_;
}

bool FxPlcEmulator::read_bit(protocol::fx::Device device) const noexcept {
  const std::lock_guard lock{mutex_};
  return memory_.get(device) != 0;
}

std::uint16_t FxPlcEmulator::read_word(protocol::fx::Device device) const noexcept {
  const std::lock_guard lock{mutex_};
  return static_cast<std::uint16_t>(memory_.get(device));
}

}  // namespace emulator_models
