#include "emulator_models/soft_plc/device_blocks.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace emulator_models::soft_plc {
namespace {

using std::chrono::nanoseconds;

bool bit(const std::byte* memory, BitDevice device) noexcept {
  return (std::to_integer<unsigned>(memory[device.byte_index]) >> device.bit_index & 1U) != 0;
}

void write(std::byte* memory, BitDevice device, bool on) noexcept {
  const std::byte mask = std::byte{1} << device.bit_index;
  std::byte& byte = memory[device.byte_index];
  byte = on ? byte | mask : byte & ~mask;
}

/// Low byte first; il_types.hpp sees to it that this is the host's order.
template <typename Value>
Value value(const std::byte* memory, const BlockDevices& devices) noexcept {
  Value found{};
  std::memcpy(&found, memory + devices.value_byte_index, sizeof found);
  return found;
}

template <typename Value>
void write(std::byte* memory, const BlockDevices& devices, Value current, Value preset) noexcept {
  std::memcpy(memory + devices.value_byte_index, &current, sizeof current);
  write(memory, devices.contact, current >= preset);
}

template <typename Value>
void clear(std::byte* memory, const BlockDevices& devices) noexcept {
  const Value zero{};
  std::memcpy(memory + devices.value_byte_index, &zero, sizeof zero);
  write(memory, devices.contact, false);
}

void count_time(DeviceTimer& timer, std::byte* memory, nanoseconds now) noexcept {
  if (timer.was_on) timer.rest += std::max(now - timer.last_call, nanoseconds{0});
  timer.was_on = true;
  timer.last_call = now;
  const std::int64_t units = timer.rest / timer.devices.unit;
  timer.rest %= timer.devices.unit;
  const std::int64_t preset = std::max<std::int64_t>(timer.pv, 0);
  const std::int64_t before = value<std::int16_t>(memory, timer.devices);
  // The port may have written more than PV: that stays, and the contact is on.
  const std::int64_t current = before >= preset ? before : std::min(before + units, preset);
  write(memory, timer.devices, static_cast<std::int16_t>(current), static_cast<std::int16_t>(preset));
}

}  // namespace

void DeviceTimer::call(std::byte* memory, nanoseconds now) noexcept {
  if (in) return count_time(*this, memory, now);
  was_on = false;
  rest = nanoseconds{0};
  clear<std::int16_t>(memory, devices);
}

void DeviceTimer::call_retentive(std::byte* memory, nanoseconds now) noexcept {
  if (r) {
    was_on = false;
    rest = nanoseconds{0};
    clear<std::int16_t>(memory, devices);
  } else if (in) {
    count_time(*this, memory, now);
  } else {
    was_on = false;
  }
}

void DeviceCounter::call(std::byte* memory) noexcept {
  const bool was_on_before = std::exchange(was_on, cu);
  const bool risen = cu && !was_on_before;
  if (r) return clear<std::int16_t>(memory, devices);
  const auto current = value<std::int16_t>(memory, devices);
  const bool counts = risen && current < pv;
  write(memory, devices, static_cast<std::int16_t>(current + (counts ? 1 : 0)), pv);
}

void WideDeviceCounter::call(std::byte* memory) noexcept {
  const bool was_on_before = std::exchange(was_on, cu);
  const bool risen = cu && !was_on_before;
  if (r) return clear<std::int32_t>(memory, devices);
  auto current = value<std::uint32_t>(memory, devices);
  if (risen) current += bit(memory, devices.counts_down) ? ~0U : 1U;
  write(memory, devices, static_cast<std::int32_t>(current), pv);
}

}  // namespace emulator_models::soft_plc
