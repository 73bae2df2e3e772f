#include "kernel_mocks/geometry_task.hpp"

#include "protocol/check.hpp"

namespace kernel_mocks {

GeometryTask::GeometryTask(Notifier& notifier) : notifier_{notifier}, thread_{[this] { run(); }} {}

GeometryTask::~GeometryTask() {
  {
    const std::scoped_lock lock{mutex_};
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void GeometryTask::start(std::chrono::nanoseconds duration) noexcept {
  {
    const std::scoped_lock lock{mutex_};
    PLC_CHECK(!moving_);
    remaining_ = duration;
    moving_ = true;
  }
  changed_.notify_one();
}

void GeometryTask::set_held(bool held) noexcept {
  {
    const std::scoped_lock lock{mutex_};
    if (held == held_) return;
    held_ = held;
  }
  changed_.notify_one();
}

bool GeometryTask::is_moving() const noexcept {
  const std::scoped_lock lock{mutex_};
  return moving_;
}

void GeometryTask::run() noexcept {
  std::unique_lock lock{mutex_};
  while (!stopping_) {
    if (!moving_ || held_) {
      changed_.wait(lock, [this] { return stopping_ || (moving_ && !held_); });
      continue;
    }
    const auto begin = Clock::now();
    changed_.wait_until(lock, begin + remaining_, [this] { return stopping_ || held_; });
    remaining_ -= Clock::now() - begin;
    if (remaining_ > std::chrono::nanoseconds{0}) continue;
    moving_ = false;
    lock.unlock();
    notifier_.notify();
    lock.lock();
  }
}

}  // namespace kernel_mocks
