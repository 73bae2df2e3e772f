#include "emulator_models/fx_recorder.hpp"

#include <algorithm>

#include "emulator_models/fx_plc.hpp"

namespace emulator_models {
namespace {

using protocol::fx::Command;
using protocol::fx::Device;
using soft_plc::EventKind;
using soft_plc::EventRecord;

/// As bit numbers of DeviceMemory::bytes().
std::vector<std::size_t> bits_of(const std::vector<Device>& devices, protocol::fx::Model model) {
  const DeviceMemory layout{model};
  std::vector<std::size_t> bits;
  for (const Device device : devices) {
    const DeviceMemory::Place place = layout.place_of(device);
    bits.push_back(std::size_t{8} * place.byte_index + place.bit_index);
  }
  return bits;
}

PortArea area_of(Command command) noexcept {
  const bool is_wide = protocol::fx::is_wide(command);
  if (command == Command::write || command == Command::write_wide)
    return is_wide ? PortArea::bytes_wide : PortArea::bytes;
  return is_wide ? PortArea::bits_wide : PortArea::bits;
}

}  // namespace

FxRecorder::FxRecorder(const FxRecorderConfig& config, protocol::fx::Model model, SteadyTime power_up)
    : ring_{config.ring_records},
      cycle_{ring_, 0, power_up.time_since_epoch()},
      signals_{ring_, 0, bits_of(config.signals, model)},
      values_{config.values.size()},
      devices_{config.values},
      published_(config.values.size()),
      power_up_{power_up} {}

void FxRecorder::step_ordered(const FxPlc& plc, const DeviceMemory* memory, SteadyTime now) noexcept {
  scan_ = {plc.task().scan_number(), now - power_up_};
  if (plc.program_fault()) cycle_.program_failed_at(plc.program_fault()->place);
  cycle_.observe(plc.task(), scan_.scan_number, now.time_since_epoch());
  if (memory == nullptr || plc.task().is_in_scan()) return;
  signals_.observe(memory->bytes(), scan_.scan_number, scan_.time.count());
  std::ranges::transform(devices_, published_.begin(), [&](Device device) { return memory->get(device); });
  values_.publish(scan_, published_);
}

void FxRecorder::request_served(std::span<const std::byte> request,
                                const protocol::fx::FrameBytes& answer) noexcept {
  if (answer.size() != 1 || answer.front() != protocol::fx::ack) return;
  const auto decoded = protocol::fx::decode_request(request);
  if (!decoded) return;  // ENQ
  const PortArea area = area_of(decoded->command);
  const bool is_force = area == PortArea::bits || area == PortArea::bits_wide;
  std::uint64_t first_bytes =
      decoded->command == Command::force_on || decoded->command == Command::force_on_wide ? 1 : 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(decoded->data.size(), sizeof first_bytes); ++i)
    first_bytes |= std::to_integer<std::uint64_t>(decoded->data[i]) << (8 * i);
  (void)ring_.push({.kind = EventKind::port_write,
                    .code = static_cast<std::uint16_t>(area),
                    .time_ns = scan_.time.count(),
                    .scan_number = scan_.scan_number,
                    .values = {decoded->address, is_force ? 1 : decoded->count_bytes,
                               static_cast<std::int64_t>(first_bytes)}});
}

}  // namespace emulator_models
