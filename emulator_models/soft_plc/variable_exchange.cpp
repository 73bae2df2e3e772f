#include "emulator_models/soft_plc/variable_exchange.hpp"

#include <algorithm>
#include <utility>

#include "protocol/check.hpp"

namespace emulator_models::soft_plc {

VariableExchange::VariableExchange(std::vector<Section> sections)
    : sections_{std::move(sections)}, sent_(memory_bytes_max) {
  for (const Section& section : sections_) PLC_CHECK(section.fits(memory_bytes_max));
}

void VariableExchange::send(std::size_t cycle, std::span<const std::byte> memory) noexcept {
  const Section& own = sections_[cycle];
  PLC_CHECK(own.fits(memory.size()));
  const std::lock_guard lock{mutex_};
  std::copy_n(memory.begin() + static_cast<std::ptrdiff_t>(own.first), own.bytes,
              sent_.begin() + static_cast<std::ptrdiff_t>(own.first));
}

void VariableExchange::receive(std::size_t cycle, std::span<std::byte> memory) const noexcept {
  const std::lock_guard lock{mutex_};
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const Section& theirs = sections_[i];
    if (i == cycle || !theirs.fits(memory.size())) continue;
    std::copy_n(sent_.begin() + static_cast<std::ptrdiff_t>(theirs.first), theirs.bytes,
                memory.begin() + static_cast<std::ptrdiff_t>(theirs.first));
  }
}

bool VariableExchange::is_received(std::size_t cycle, const Section& section) const noexcept {
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    if (i != cycle && sections_[i].overlaps(section)) return true;
  }
  return false;
}

}  // namespace emulator_models::soft_plc
