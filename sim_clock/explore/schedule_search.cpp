#include "sim_clock/explore/schedule_search.hpp"

#include <unordered_set>

namespace ltsim {

ScheduleSearch::End ScheduleSearch::deepen(const SearchFilter& filter, std::size_t length_max,
                                           Equivalence equivalence, double until) {
  const auto hash = [&] { return equivalence == Equivalence::exact ? last_.trace_hash : last_.causal_hash; };
  if (budget_.used() >= until) return End::out_of_budget;
  if (leads_to_failure({})) return End::found;
  std::unordered_set<std::uint64_t> seen{hash()};
  std::vector<AddressedSchedule> to_extend{{}};
  bool all_extended = true;
  for (std::size_t length = 1; length <= length_max; ++length) {
    std::vector<AddressedSchedule> to_extend_next;
    for (AddressedSchedule& schedule : to_extend) {
      if (budget_.used() >= until) return End::out_of_budget;
      const auto next = alternatives(schedule, filter, false);
      schedule.emplace_back();
      for (const AddressedDeviation& deviation : next) {
        if (budget_.used() >= until) return End::out_of_budget;
        schedule.back() = deviation;
        if (leads_to_failure(schedule)) return End::found;
        if (length == length_max || !seen.insert(hash()).second) continue;
        if (to_extend_next.size() < extended_max) {
          to_extend_next.push_back(schedule);
        } else {
          all_extended = false;
        }
      }
    }
    to_extend = std::move(to_extend_next);
  }
  return all_extended ? End::exhausted : End::out_of_budget;
}

ScheduleSearch::End ScheduleSearch::exchange(const AddressedSchedule& schedule, const SearchFilter& filter,
                                             double until) {
  for (std::size_t first = 0; first < schedule.size(); ++first) {
    for (std::size_t second = first + 1; second < schedule.size(); ++second) {
      if (budget_.used() >= until) return End::out_of_budget;
      AddressedSchedule shorter;
      for (std::size_t i = 0; i < schedule.size(); ++i) {
        if (i != first && i != second) shorter.push_back(schedule[i]);
      }
      const auto others = alternatives(shorter, filter, true);
      shorter.emplace_back();
      for (const AddressedDeviation& other : others) {
        if (budget_.used() >= until) return End::out_of_budget;
        shorter.back() = other;
        if (leads_to_failure(shorter)) return End::found;
      }
    }
  }
  return End::exhausted;
}

std::vector<AddressedDeviation> ScheduleSearch::alternatives(const AddressedSchedule& schedule,
                                                             const SearchFilter& filter, bool anywhere) {
  strategy_.list_alternatives(&filter, anywhere);
  run(schedule);
  strategy_.list_alternatives(nullptr, false);
  return std::move(last_.alternatives);
}

bool ScheduleSearch::leads_to_failure(const AddressedSchedule& schedule) {
  run(schedule);
  const Outcome& outcome = last_.outcome;
  return !outcome.passed() && is_the_failure_(outcome) && accept_(schedule);
}

void ScheduleSearch::run(const AddressedSchedule& schedule) {
  strategy_.set_deviations(schedule);
  last_ = explorer_.apart<Tried>([this] {
    try {
      explorer_.execute(scenario_, strategy_, 0, nullptr);
    } catch (const Explorer::NotSimulable&) {
      // Where nobody went before there may be a call that is not simulated: no finding, and no reason to stop.
    }
    const Scheduler& scheduler = world_.scheduler();
    return Tried{.outcome = scheduler.outcome(),
                 .points = scheduler.points(),
                 .trace_hash = scheduler.trace_hash(),
                 .causal_hash = strategy_.causal_hash(),
                 .alternatives = strategy_.alternatives()};
  });
  budget_.use(last_.points);
}

}  // namespace ltsim
