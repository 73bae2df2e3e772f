// A deadline on the steady clock.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>

namespace protocol {

/// The instant `timeout` from `begin`, or the last instant of the clock when the sum lies beyond it.
[[nodiscard]] inline std::chrono::steady_clock::time_point deadline_after(
    std::chrono::nanoseconds timeout,
    std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now()) noexcept {
  constexpr auto last = std::chrono::steady_clock::time_point::max();
  return timeout < last - begin ? begin + timeout : last;
}

/// The same instant for the calls of POSIX that are told CLOCK_MONOTONIC, which is what the steady clock is.
[[nodiscard]] inline std::timespec on_monotonic_clock(std::chrono::steady_clock::time_point time) noexcept {
  const std::chrono::nanoseconds since_begin =
      std::max(time.time_since_epoch(), std::chrono::steady_clock::duration::zero());
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(since_begin);
  return {.tv_sec = static_cast<std::time_t>(seconds.count()),
          .tv_nsec = static_cast<long>((since_begin - seconds).count())};
}

}  // namespace protocol
