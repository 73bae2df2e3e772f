// Clocks that a soft PLC must not run on, and one that is watched.
#pragma once

#include <chrono>
#include <cstdint>

#include "emulator_models/soft_plc/plc_threads.hpp"
#include "sim_clock/world/world.hpp"
#include "tests/scenarios/plc/plc_monitor.hpp"

namespace scenarios::soft_plc {

/// Goes with what people set.
class WallPlcClock final : public emulator_models::soft_plc::PlcClock {
 public:
  std::chrono::nanoseconds now() noexcept override {
    return std::chrono::system_clock::now().time_since_epoch() - ltsim::World::wall_clock_epoch;
  }
  void wait_until(std::condition_variable& wake, std::unique_lock<std::mutex>& lock,
                  std::chrono::nanoseconds time) noexcept override {
    wake.wait_until(lock, std::chrono::system_clock::time_point{time + ltsim::World::wall_clock_epoch});
  }
};

/// A count of milliseconds in 32 bits, 40 ms before it wraps when the world begins.
class MillisecondPlcClock final : public emulator_models::soft_plc::PlcClock {
 public:
  static constexpr std::uint32_t at_the_beginning = 0U - 40U;

  std::chrono::nanoseconds now() noexcept override {
    const auto since = std::chrono::steady_clock::now().time_since_epoch();
    const auto passed = std::chrono::duration_cast<std::chrono::milliseconds>(since).count();
    return std::chrono::milliseconds{at_the_beginning + static_cast<std::uint32_t>(passed)};
  }
  void wait_until(std::condition_variable& wake, std::unique_lock<std::mutex>& lock,
                  std::chrono::nanoseconds time) noexcept override {
    wake.wait_for(lock, time - now());
  }
};

/// Tells the monitor what the PLC has read.
class WatchedPlcClock final : public emulator_models::soft_plc::PlcClock {
 public:
  WatchedPlcClock(PlcMonitor& monitor, emulator_models::soft_plc::PlcClock& clock)
      : monitor_{monitor}, clock_{clock} {}

  std::chrono::nanoseconds now() noexcept override {
    const std::chrono::nanoseconds read = clock_.now();
    monitor_.clock_read(read);
    return read;
  }
  void wait_until(std::condition_variable& wake, std::unique_lock<std::mutex>& lock,
                  std::chrono::nanoseconds time) noexcept override {
    clock_.wait_until(wake, lock, time);
  }

 private:
  PlcMonitor& monitor_;
  emulator_models::soft_plc::PlcClock& clock_;
};

}  // namespace scenarios::soft_plc
