#include "emulator_models/scan_boundary_port.hpp"

#include <algorithm>

namespace emulator_models {

ScanBoundaryPort::ScanBoundaryPort(FxPlcEmulator& plc, std::chrono::nanoseconds patience) noexcept
    : plc_{plc}, patience_{patience} {}

protocol::fx::FrameBytes ScanBoundaryPort::process(std::span<const std::byte> request) noexcept {
  Waiting waiting{.request = request, .answer = {}};
  std::unique_lock lock{mutex_};
  if (queue_length_ == waiting_max) return {};
  queue_[queue_length_++] = &waiting;
  const auto deadline = std::chrono::steady_clock::now() + patience_;
  if (!answered_.wait_until(lock, deadline, [&] { return waiting.done; })) withdraw(waiting);
  return waiting.answer;
}

void ScanBoundaryPort::serve(const FxPlcEmulator::LockedMemory& memory) noexcept {
  const std::lock_guard lock{mutex_};
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
