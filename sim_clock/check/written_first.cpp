#include "sim_clock/check/written_first.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {

void WrittenFirst::declare(std::string_view segment, std::uint32_t offset, std::uint32_t bytes,
                           std::string_view name) {
  if (bytes == 0 || bytes > Segments::segment_bytes_max) {
    world_.unsupported(
        fmt::format("written_first of {} bytes: a region has 1 to {}", bytes, Segments::segment_bytes_max));
    return;
  }
  if (regions_count_ == regions_.size()) regions_.emplace_back();
  Region& region = regions_[regions_count_++];
  region.segment.assign(segment);
  region.offset = offset;
  region.name.assign(name);
  region.written.assign(bytes, false);
}

void WrittenFirst::performs(const Task& task, const Operation& operation) noexcept {
  if (!is_memory_access(operation.kind) || operation.object == 0) return;
  for (std::size_t i = 0; i < regions_count_; ++i) {
    Region& region = regions_[i];
    const auto region_end = region.offset + static_cast<std::uint32_t>(region.written.size());
    const std::uint32_t begin = std::max(region.offset, operation.offset);
    const std::uint32_t end = std::min(region_end, operation.offset + operation.bytes);
    if (begin >= end || world_.objects().object_name(operation.object) != region.segment) continue;
    const bool reads = !changes_memory(operation.kind) || operation.kind == OperationKind::atomic_exchange ||
                       operation.kind == OperationKind::atomic_update;
    for (std::uint32_t at = begin - region.offset; at < end - region.offset; ++at) {
      if (reads && !region.written[at]) {
        const GhostScope ghost;
        world_.violated(fmt::format("byte {} of {} is read by {} before anybody has written it", at,
                                    region.name, task.name));
      }
      if (changes_memory(operation.kind)) region.written[at] = true;
    }
  }
}

void WrittenFirst::add_state(StateHash& hash) const noexcept {
  for (std::size_t i = 0; i < regions_count_; ++i) {
    for (const bool written : regions_[i].written) hash.add(written ? 1 : 0);
  }
}

}  // namespace ltsim
