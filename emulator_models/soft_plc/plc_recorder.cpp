#include "emulator_models/soft_plc/plc_recorder.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "emulator_models/soft_plc/gateway.hpp"

namespace emulator_models::soft_plc {
namespace {

using std::chrono::nanoseconds;

std::vector<std::size_t> first_numbers(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

std::uint64_t load(const CycleImage& image, const DirectAddress& address) noexcept {
  const std::span<const std::byte> area = address.area == Area::inputs    ? image.inputs
                                          : address.area == Area::outputs ? image.outputs
                                                                          : image.memory;
  const std::size_t bytes = size_bytes(address.type);
  if (!Section{address.byte_index, bytes}.fits(area.size())) return 0;
  std::uint64_t value = 0;
  std::memcpy(&value, area.data() + address.byte_index, bytes);
  return address.type == ElementaryType::boolean ? value >> address.bit_index & 1U : value;
}

}  // namespace

PlcRecorder::Cycle::Cycle(const PlcRecorderConfig& config, std::size_t number, nanoseconds power_up)
    : ring{config.ring_records},
      recorder{ring, static_cast<std::uint8_t>(number), power_up},
      signals{ring, static_cast<std::uint8_t>(number), first_numbers(config.signals.size())},
      values{config.values.size()},
      bits(config.signals.size() / 8 + 1),
      published(config.values.size()) {}

PlcRecorder::PlcRecorder(const PlcRecorderConfig& config, std::size_t cycles_count, nanoseconds power_up)
    : config_{config}, power_up_{power_up} {
  for (std::size_t i = 0; i < cycles_count; ++i)
    cycles_.push_back(std::make_unique<Cycle>(config_, i, power_up));
}

void PlcRecorder::step_ordered(std::size_t index, const ScanTask& task, const CycleImage& image,
                               nanoseconds now) noexcept {
  Cycle& cycle = *cycles_[index];
  // The end of a scan and the start of the next one can come with one call.
  const bool has_ended =
      cycle.is_open && (!task.is_in_scan() || task.scan_number() != cycle.scan.scan_number);
  cycle.recorder.observe(task, task.scan_number(), now);
  if (has_ended) end_scan(cycle, image);
  cycle.is_open = task.is_in_scan();
  cycle.scan = {task.scan_number(), now - power_up_};
}

void PlcRecorder::end_scan(Cycle& cycle, const CycleImage& image) noexcept {
  std::ranges::fill(cycle.bits, std::byte{0});
  for (std::size_t i = 0; i < config_.signals.size(); ++i)
    cycle.bits[i / 8] |= static_cast<std::byte>((load(image, config_.signals[i]) & 1U) << (i % 8));
  cycle.signals.observe(cycle.bits, cycle.scan.scan_number, cycle.scan.time.count());
  std::ranges::transform(config_.values, cycle.published.begin(),
                         [&](const DirectAddress& address) { return load(image, address); });
  cycle.values.publish(cycle.scan, cycle.published);
}

void PlcRecorder::gateway_writes(std::size_t index, const GatewayItem& item) noexcept {
  Cycle& cycle = *cycles_[index];
  std::uint64_t first_bytes = 0;
  std::memcpy(&first_bytes, item.written.data(), std::min(item.written.size(), sizeof first_bytes));
  (void)cycle.ring.push({.kind = EventKind::port_write,
                         .cycle = static_cast<std::uint8_t>(index),
                         .code = static_cast<std::uint16_t>(item.area),
                         .time_ns = cycle.scan.time.count(),
                         .scan_number = cycle.scan.scan_number,
                         .values = {static_cast<std::int64_t>(item.section.first),
                                    static_cast<std::int64_t>(item.written.size()),
                                    static_cast<std::int64_t>(first_bytes), item.bit ? *item.bit + 1 : 0}});
}

void PlcRecorder::finish(nanoseconds now) noexcept {
  for (const auto& cycle : cycles_) cycle->recorder.finish(now);
}

std::vector<EventRing*> PlcRecorder::rings() noexcept {
  std::vector<EventRing*> rings;
  for (const auto& cycle : cycles_) rings.push_back(&cycle->ring);
  return rings;
}

}  // namespace emulator_models::soft_plc
