#include "sim_clock/explore/search_filters.hpp"

#include <algorithm>

namespace ltsim {
namespace {

void make_distinct(std::vector<SimTime>& durations) {
  std::sort(durations.begin(), durations.end());
  durations.erase(std::unique(durations.begin(), durations.end()), durations.end());
}

}  // namespace

SearchFilter search_filter(Breadth breadth, const AddressedSchedule& schedule) {
  using namespace std::chrono_literals;
  SearchFilter filter;
  filter.until_next_timer = breadth != Breadth::own_choices;
  if (breadth != Breadth::everything) {
    filter.questions = {};
    filter.whole_machine = filter.single_tasks = false;
  }
  std::uint64_t tasks = 0;
  const auto task_bit = [](std::uint64_t task) {
    return std::uint64_t{1} << std::min<std::uint64_t>(task, 63);
  };
  for (const AddressedDeviation& deviation : schedule) {
    filter.questions[static_cast<std::size_t>(deviation.at.question)] = true;
    if (deviation.at.question == Question::age) tasks |= task_bit(deviation.at.whose);
    if (deviation.at.question == Question::task)
      tasks |= task_bit(deviation.at.whose) | task_bit(deviation.value);
    if (deviation.at.question != Question::slow_moment) continue;
    tasks |= task_bit(deviation.at.whose);
    (deviation.slow.others_go_on ? filter.single_tasks : filter.whole_machine) = true;
    filter.durations.push_back(deviation.slow.duration);
  }
  if (breadth == Breadth::own_choices) filter.tasks = tasks;
  make_distinct(filter.durations);
  constexpr std::size_t own_durations_max = 4;
  if (filter.durations.size() > own_durations_max)  // the longest do most
    filter.durations.erase(filter.durations.begin(), filter.durations.end() - own_durations_max);
  if (breadth != Breadth::own_choices) {
    // Some time-out of a program lies between two of these, so that it passes once and not twice.
    filter.durations.insert(filter.durations.end(), {1ms, 3ms, 15ms, 50ms, 150ms, 1s});
    make_distinct(filter.durations);
  }
  return filter;
}

SearchFilter silences_filter(const AddressedSchedule& schedule) {
  using namespace std::chrono_literals;
  SearchFilter filter;
  filter.whole_machine = filter.until_next_timer = false;
  SimTime passed{0};
  for (const AddressedDeviation& deviation : schedule) {
    if (deviation.at.question == Question::slow_moment && !deviation.slow.others_go_on)
      passed += deviation.slow.duration;
  }
  filter.durations = {1ms, passed + passed / 2};
  return filter;
}

}  // namespace ltsim
