// The on-delay timer of the soft PLC for some weeks: once ET has reached PT with IN on, Q stays on.
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "sim_clock/world/world.hpp"

namespace scenarios {

/// @tparam OnDelay  as emulator_models::soft_plc::Ton
template <typename OnDelay>
void watch_on_delay(ltsim::World& world) {
  using namespace std::chrono_literals;
  constexpr int scans_count = 80;
  constexpr auto day = 24h;
  std::atomic<bool> input{false};
  OnDelay timer;
  timer.pt = world.choose("long-preset", 2) == 0 ? std::chrono::nanoseconds{1s} : 10 * day;

  world.process("plc").start("field", [&] {
    std::this_thread::sleep_for(10ms * static_cast<int>(world.choose("input-on", 4)));
    input = true;
  });
  world.process("plc").start("scan", [&] {
    bool is_over = false;
    for (int scan = 0; scan < scans_count; ++scan) {
      timer.in = input;
      timer.call(std::chrono::steady_clock::now().time_since_epoch());
      is_over = timer.in && (is_over || timer.et >= timer.pt);
      world.require(timer.q || !is_over, "timer: its output drops though its input stayed on");
      std::this_thread::sleep_for(world.choose("days", 2) == 0 ? std::chrono::nanoseconds{10ms} : day);
    }
  });
  world.run();
}

/// Over a timer whose elapsed time wraps.
void watch_wrapping_on_delay(ltsim::World& world);

}  // namespace scenarios
