// Which deviations a search for a shorter schedule tries, from few to all.
#pragma once

#include <array>

#include "sim_clock/explore/addressed_strategy.hpp"
#include "sim_clock/explore/schedule_search.hpp"

namespace ltsim {

enum class Breadth : std::uint8_t {
  own_choices,  ///< tasks, kinds and durations that the schedule has
  own_kinds,    ///< kinds that the schedule has
  everything,
};

[[nodiscard]] SearchFilter search_filter(Breadth breadth, const AddressedSchedule& schedule);

/// What could stand for slow moments of the whole machine that are many: switches, and silences of single tasks as long
/// as all of them and half as long again, or short.
[[nodiscard]] SearchFilter silences_filter(const AddressedSchedule& schedule);

/// 1us, 2us, 5us, 10us ... 1000s: what durations in a minimal schedule look like.
inline constexpr std::array<SimTime, 28> round_durations = [] {
  std::array<SimTime, 28> durations{};
  SimTime decade = std::chrono::microseconds{1};
  for (std::size_t i = 0; i < durations.size(); ++i) {
    constexpr std::int64_t steps[]{1, 2, 5};
    durations[i] = decade * steps[i % 3];
    if (i % 3 == 2) decade *= 10;
  }
  return durations;
}();

}  // namespace ltsim
