#include "emulator_models/scan_boundary_port.hpp"

#include <algorithm>

namespace emulator_models {

ScanBoundaryPort::ScanBoundaryPort(FxPlcEmulator& plc, std::chrono::nanoseconds patience) noexcept
    : plc_{plc}, patience_{patience}, scan_time_max_{plc.read_word(watchdog_time)} {}

protocol::fx::FrameBytes ScanBoundaryPort::process(std::span<const std::byte> request) noexcept {
  Waiting waiting{.request = request, .answer = {}};
  std::unique_lock lock{mutex_};
  if (closed_ || queue_length_ == waiting_max) return {};
  queue_[queue_length_++] = &waiting;
  const auto deadline = std::chrono::steady_clock::now() + scan_time_max_ + patience_;
  if (!answered_.wait_until(lock, deadline, [&] { return waiting.done; })) withdraw(waiting);
  return waiting.answer;
}

void ScanBoundaryPort::serve(const FxPlcEmulator::LockedMemory& memory) noexcept {
  const std::lock_guard lock{mutex_};
  execute_all(memory);
  // Under the same lock: the request that follows one which has set D8000 waits as long as the scan now may.
  scan_time_max_ = std::chrono::milliseconds{memory->get(watchdog_time)};
  if (memory->get(constant_scan) != 0)
    scan_time_max_ += std::chrono::milliseconds{memory->get(constant_scan_time)};
}

void ScanBoundaryPort::close(const FxPlcEmulator::LockedMemory& memory) noexcept {
  const std::lock_guard lock{mutex_};
  execute_all(memory);
  closed_ = true;
}

void ScanBoundaryPort::execute_all(const FxPlcEmulator::LockedMemory& memory) noexcept {
  if (queue_length_ == 0) return;
  for (std::size_t i = 0; i < queue_length_; ++i) {
    queue_[i]->answer = plc_.process(queue_[i]->request, memory);
    queue_[i]->done = true;
    if (observer_ != nullptr) observer_->request_served(queue_[i]->request, queue_[i]->answer);
  }
  queue_length_ = 0;
  answered_.notify_all();
}

void ScanBoundaryPort::observe_with(FxPlcObserver* observer) noexcept {
  const std::lock_guard lock{mutex_};
  observer_ = observer;
}

void ScanBoundaryPort::withdraw(const Waiting& waiting) noexcept {
  const auto end = queue_.begin() + static_cast<std::ptrdiff_t>(queue_length_);
  queue_length_ = static_cast<std::size_t>(std::remove(queue_.begin(), end, &waiting) - queue_.begin());
}

}  // namespace emulator_models
