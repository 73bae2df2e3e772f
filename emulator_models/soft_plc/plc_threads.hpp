// Runs a soft PLC on threads: all cycles on one, or one for each; the watchdog and every driver on one of their own.
//
// Time and waiting come from a PlcClock, steady_clock by default. SCHED_FIFO is asked for on request, the watchdog above
// all cycles; where the host refuses, the PLC runs as ordinary threads and says so.
// Outputs that have become safe wake every driver: they do not wait for its period.
// stop() carries out a STOP: it closes the gate, so that the outputs are safe, lets each driver bring them to the field,
// and joins every thread. It waits for a cycle or a driver that hangs, for a thread cannot be taken away from its code.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "emulator_models/soft_plc/inheriting_mutex.hpp"
#include "emulator_models/soft_plc/soft_plc.hpp"

namespace emulator_models::soft_plc {

class PlcClock {
 public:
  virtual ~PlcClock() = default;
  [[nodiscard]] virtual std::chrono::nanoseconds now() noexcept = 0;
  /// Waits until the time has come or somebody notifies; may return early.
  virtual void wait_until(std::condition_variable& wake, std::unique_lock<std::mutex>& lock,
                          std::chrono::nanoseconds time) noexcept = 0;

 protected:
  PlcClock() = default;
  PlcClock(const PlcClock&) = default;
  PlcClock& operator=(const PlcClock&) = default;
};

class SteadyPlcClock final : public PlcClock {
 public:
  std::chrono::nanoseconds now() noexcept override;
  void wait_until(std::condition_variable& wake, std::unique_lock<std::mutex>& lock,
                  std::chrono::nanoseconds time) noexcept override;
};

enum class PlcThreading : std::uint8_t { one, per_cycle };

class PlcThreads {
 public:
  /// Longest wait of a cycle and of the watchdog: so late does a cycle of a long period notice a fault of another one
  /// when there were no outputs to make safe.
  static constexpr std::chrono::milliseconds wait_max{50};

  /// Starts all threads. PLC and clock must outlive them.
  PlcThreads(SoftPlc& plc, PlcClock& clock, PlcThreading threading, bool realtime);
  PlcThreads(const PlcThreads&) = delete;
  PlcThreads& operator=(const PlcThreads&) = delete;
  ~PlcThreads() { stop(); }

  /// Once it has returned, no thread runs any more. May be called again.
  void stop() noexcept;
  /// @return why SCHED_FIFO is not in use; empty if it is, or was not asked for
  [[nodiscard]] std::string realtime_refusal() const;

 private:
  enum class AtEnd : std::uint8_t { nothing, once_more };
  void start(int realtime_priority, AtEnd at_end, std::function<std::chrono::nanoseconds()> work);
  void repeat(const std::function<std::chrono::nanoseconds()>& work) noexcept;
  /// By whoever starts the threads, one after the other: the watchdog has its priority before there is a cycle. A thread
  /// that asked for itself could wait for its first turn behind a cycle that hangs.
  void ask_for_realtime(std::thread& thread, int priority) noexcept;

  SoftPlc& plc_;
  PlcClock& clock_;
  const bool realtime_;
  mutable InheritingMutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;         ///< guarded by mutex_
  std::uint64_t safe_count_ = 0;  ///< how often outputs have become safe; guarded by mutex_
  int refusal_ = 0;               ///< an errno; settled when all threads have been started
  std::vector<std::thread> threads_;
};

}  // namespace emulator_models::soft_plc
