// The kernel's geometry task: a thread that lets axis motion take its time.
//
// A motion lasts its duration, not counting the time in which it is held (feed hold, feed enable off). It knows
// nothing of the PLC: the runner holds it and tells the PLC of it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "kernel_mocks/notifier.hpp"

namespace kernel_mocks {

class GeometryTask {
 public:
  /// @param notifier  told of the end of each motion; must outlive the task
  explicit GeometryTask(Notifier& notifier);
  GeometryTask(const GeometryTask&) = delete;
  GeometryTask& operator=(const GeometryTask&) = delete;
  /// A motion under way is abandoned.
  ~GeometryTask();

  /// The motion before must have ended.
  void start(std::chrono::nanoseconds duration) noexcept;
  void set_held(bool held) noexcept;
  [[nodiscard]] bool is_moving() const noexcept;

 private:
  using Clock = std::chrono::steady_clock;

  void run() noexcept;

  Notifier& notifier_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::chrono::nanoseconds remaining_{0};
  bool moving_ = false;
  bool held_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace kernel_mocks
