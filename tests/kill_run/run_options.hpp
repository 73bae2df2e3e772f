// What a run is told, and the time-outs that follow.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "protocol/hardened/options.hpp"

namespace kill_run {

enum class Victims : std::uint8_t { kernel, emulator, either };

struct RunOptions {
  std::string name;                 ///< of the segment
  bool owns_shared_memory = false;  ///< whatever is in /dev/shm is of this run
  std::uint64_t kills = 2000;
  std::uint64_t seed = 1;
  Victims victims = Victims::either;
  protocol::hardened::Options::Doorbells doorbells = protocol::hardened::Options::Doorbells::two;
  protocol::hardened::Rules rules = {};
};

/// Short, so that requests are withdrawn and given up all the time.
struct TimeOuts {
  std::chrono::nanoseconds take = std::chrono::milliseconds{4};
  std::chrono::nanoseconds answer = std::chrono::milliseconds{1};
};
inline constexpr TimeOuts usual_time_outs;
/// Of a fresh request, which must end ok: no busy machine delays a process for so long, a sleeper that nobody wakes
/// sleeps for ever.
inline constexpr TimeOuts fresh_time_outs{.take = std::chrono::seconds{4}, .answer = std::chrono::seconds{4}};
inline constexpr std::chrono::seconds open_timeout{10};
/// Longest execution, beyond the time-outs.
inline constexpr std::chrono::microseconds work_max{20'000};

[[nodiscard]] inline protocol::hardened::Options protocol_options(const RunOptions& run) {
  protocol::hardened::Options options;
  options.doorbells = run.doorbells;
  options.take_timeout = usual_time_outs.take;
  options.answer_timeout = usual_time_outs.answer;
  options.poll_interval = std::chrono::microseconds{20};
  options.open_timeout = open_timeout;
  options.rules = run.rules;
  return options;
}

/// I15: how long a call may last by its time-outs.
[[nodiscard]] inline std::chrono::nanoseconds call_bound(const TimeOuts& time_outs) {
  return (time_outs.take + time_outs.answer) * (1 + protocol::hardened::Options{}.queries_max);
}
/// What a busy machine may add to it.
inline constexpr std::chrono::seconds scheduling_allowance{4};

}  // namespace kill_run
