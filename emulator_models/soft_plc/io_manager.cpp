#include "emulator_models/soft_plc/io_manager.hpp"

#include <algorithm>
#include <utility>

#include "protocol/check.hpp"

namespace emulator_models::soft_plc {

using std::chrono::nanoseconds;

IoManager::IoManager(std::vector<Slot> slots, nanoseconds now) {
  for (Slot& slot : slots) {
    PLC_CHECK(slot.config.inputs.fits(inputs_bytes_max));
    PLC_CHECK(!slot.config.stale_bit || *slot.config.stale_bit < inputs_bytes_max * 8);
    drivers_.push_back({std::move(slot.config), std::move(slot.driver), now, 0, {}});
  }
}

void IoManager::end_exchange(std::size_t index, bool good, std::span<const std::byte> inputs,
                             nanoseconds now) noexcept {
  const std::lock_guard lock{mutex_};
  Driver& driver = drivers_[index];
  ++driver.state.exchanges_count;
  if (!good) {
    ++driver.state.failures_count;
    if (++driver.failures_in_row >= driver.config.failures_max) set_stale(driver, true);
    return;
  }
  driver.failures_in_row = 0;
  driver.last_good = now;
  set_stale(driver, false);
  std::ranges::copy(inputs, inputs_.begin() + static_cast<std::ptrdiff_t>(driver.config.inputs.first));
}

void IoManager::set_stale(Driver& driver, bool stale) noexcept {
  if (stale && !driver.state.stale) ++driver.state.stale_count;
  driver.state.stale = stale;
  if (!driver.config.stale_bit) return;
  const std::byte bit{static_cast<unsigned char>(1U << *driver.config.stale_bit % 8)};
  std::byte& target = inputs_[*driver.config.stale_bit / 8];
  target = stale ? target | bit : target & ~bit;
}

void IoManager::latch(std::span<std::byte> inputs) const noexcept {
  const std::lock_guard lock{mutex_};
  std::copy_n(inputs_.begin(), std::min(inputs.size(), inputs_.size()), inputs.begin());
}

std::optional<std::size_t> IoManager::supervise(nanoseconds now) noexcept {
  const std::lock_guard lock{mutex_};
  std::optional<std::size_t> fault;
  for (std::size_t i = 0; i < drivers_.size(); ++i) {
    Driver& driver = drivers_[i];
    if (now - driver.last_good > driver.config.late_after) set_stale(driver, true);
    if (driver.state.stale && driver.config.stale_is_fault && !fault) fault = i;
  }
  return fault;
}

nanoseconds IoManager::next_look() const noexcept {
  const std::lock_guard lock{mutex_};
  nanoseconds next = nanoseconds::max();
  for (const Driver& driver : drivers_) {
    if (!driver.state.stale)
      next = std::min(next, driver.last_good + driver.config.late_after + nanoseconds{1});
  }
  return next;
}

DriverState IoManager::state(std::size_t index, nanoseconds now) const noexcept {
  const std::lock_guard lock{mutex_};
  DriverState state = drivers_[index].state;
  state.age = now - drivers_[index].last_good;
  return state;
}

}  // namespace emulator_models::soft_plc
