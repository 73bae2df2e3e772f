// A deadline on the steady clock.
#pragma once

#include <chrono>

namespace protocol {

/// The instant `timeout` from now, or the last instant of the clock when the sum lies beyond it.
[[nodiscard]] inline std::chrono::steady_clock::time_point deadline_after(
    std::chrono::nanoseconds timeout) noexcept {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point now = Clock::now();
  return timeout < Clock::time_point::max() - now ? now + timeout : Clock::time_point::max();
}

}  // namespace protocol
