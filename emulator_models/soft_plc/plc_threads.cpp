#include "emulator_models/soft_plc/plc_threads.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <pthread.h>

namespace emulator_models::soft_plc {
namespace {

using std::chrono::nanoseconds;
using std::chrono::steady_clock;

// Below the host's own real-time threads, which begin at 50 on Linux.
constexpr int realtime_priority_of_watchdog = 40;
constexpr int realtime_priority_of_drivers = 1;

}  // namespace

nanoseconds SteadyPlcClock::now() noexcept { return steady_clock::now().time_since_epoch(); }

void SteadyPlcClock::wait_until(std::condition_variable& wake, std::unique_lock<std::mutex>& lock,
                                nanoseconds time) noexcept {
  wake.wait_until(lock, steady_clock::time_point{time});
}

PlcThreads::PlcThreads(SoftPlc& plc, PlcClock& clock, PlcThreading threading, bool realtime)
    : plc_{plc}, clock_{clock}, realtime_{realtime} {
  plc_.gate().on_safe([this] {
    const std::lock_guard lock{mutex_};
    ++safe_count_;
    wake_.notify_all();
  });
  const auto soon = [this](nanoseconds due) { return std::min(due, clock_.now() + nanoseconds{wait_max}); };
  start(realtime_priority_of_watchdog, AtEnd::nothing,
        [this, soon] { return soon(plc_.supervise(clock_.now())); });
  for (std::size_t i = 0; i < plc_.io().drivers_count(); ++i) {
    start(realtime_priority_of_drivers, AtEnd::once_more, [this, i] {
      const nanoseconds begin = clock_.now();
      plc_.io().exchange(i, plc_.gate(), [this] { return clock_.now(); });
      return begin + plc_.io().config(i).period;
    });
  }
  if (threading == PlcThreading::one) {
    start(realtime_priority_of_watchdog - 1, AtEnd::nothing,
          [this, soon] { return soon(plc_.advance(clock_.now())); });
    return;
  }
  for (std::size_t i = 0; i < plc_.cycles_count(); ++i) {
    const int below = static_cast<int>(std::min<std::size_t>(plc_.priority(i), cycles_max));
    start(realtime_priority_of_watchdog - 1 - below, AtEnd::nothing,
          [this, soon, i] { return soon(plc_.advance_cycle(i, clock_.now())); });
  }
}

void PlcThreads::start(int realtime_priority, AtEnd at_end, std::function<nanoseconds()> work) {
  threads_.emplace_back([this, at_end, work = std::move(work)] {
    repeat(work);
    if (at_end == AtEnd::once_more) work();
  });
  if (realtime_) ask_for_realtime(threads_.back(), realtime_priority);
}

void PlcThreads::repeat(const std::function<nanoseconds()>& work) noexcept {
  std::unique_lock<std::mutex> lock{mutex_};
  while (!stopping_) {
    const std::uint64_t seen = safe_count_;
    lock.unlock();
    const nanoseconds due = work();
    lock.lock();
    while (!stopping_ && safe_count_ == seen && clock_.now() < due) clock_.wait_until(wake_, lock, due);
  }
}

void PlcThreads::ask_for_realtime(std::thread& thread, int priority) noexcept {
  const sched_param parameter{.sched_priority = priority};
  if (const int error = pthread_setschedparam(thread.native_handle(), SCHED_FIFO, &parameter); error != 0)
    refusal_ = error;
}

void PlcThreads::stop() noexcept {
  plc_.stop_now();
  {
    const std::lock_guard lock{mutex_};
    stopping_ = true;
    wake_.notify_all();
  }
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
  plc_.gate().on_safe(nullptr);
}

std::string PlcThreads::realtime_refusal() const {
  if (refusal_ == 0) return {};
  return std::string{"SCHED_FIFO was refused ("} + std::strerror(refusal_) +
         "): scans run with ordinary priority; allow it with ulimit -r, or set realtime = false";
}

}  // namespace emulator_models::soft_plc
