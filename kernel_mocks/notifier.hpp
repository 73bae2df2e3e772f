// One thread waits for any of several others: a flag that stays up until it has been seen.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace kernel_mocks {

class Notifier {
 public:
  void notify() noexcept {
    const std::scoped_lock lock{mutex_};
    raised_ = true;
    changed_.notify_one();
  }

  /// Returns at once when notify() was called since the last return.
  void wait_for(std::chrono::nanoseconds longest) noexcept {
    std::unique_lock lock{mutex_};
    changed_.wait_for(lock, longest, [this] { return raised_; });
    raised_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool raised_ = false;
};

}  // namespace kernel_mocks
