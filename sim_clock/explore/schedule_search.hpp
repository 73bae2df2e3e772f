// Looks for short schedules that lead to a given failure, without regard to how it was found.
//
// Two ways. deepen() tries all schedules of one deviation, then all of two, and so on: what it finds first is
// the smallest there is, among the deviations that the filter lets it try. exchange() takes two deviations out
// of a schedule that fails and puts one other in: it reaches what lies too deep for the first.
//
// Executions with equal hashes go on alike, so that only the first of them is extended. With Equivalence::causal
// that is a guess (where a switch lies between two steps that matter can make a difference to the next
// deviation), with Equivalence::exact it is certain.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "sim_clock/explore/addressed_strategy.hpp"
#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/search_budget.hpp"

namespace ltsim {

using AddressedSchedule = std::vector<AddressedDeviation>;

class ScheduleSearch {
 public:
  enum class Equivalence : std::uint8_t { causal, exact };
  enum class End : std::uint8_t { found, exhausted, out_of_budget };
  /// Told each schedule that ends in the failure. @return whether the search is over
  using Accept = std::function<bool(const AddressedSchedule&)>;

  /// @param is_the_failure  whether an outcome is the one that is looked for
  ScheduleSearch(Explorer& explorer, World& world, const Scenario& scenario,
                 std::function<bool(const Outcome&)> is_the_failure, Accept accept, SearchBudget& budget)
      : explorer_(explorer),
        world_(world),
        scenario_(scenario),
        is_the_failure_(std::move(is_the_failure)),
        accept_(std::move(accept)),
        budget_(budget) {}

  /// @param length_max  deviations in the longest schedules to try
  /// @param until       ends when so much of the budget is used, 0 to 1
  [[nodiscard]] End deepen(const SearchFilter& filter, std::size_t length_max, Equivalence equivalence,
                           double until);

  /// @param schedule  fails; what is accepted is shorter by one
  [[nodiscard]] End exchange(const AddressedSchedule& schedule, const SearchFilter& filter, double until);

  /// All that could be added to `schedule`, in order of time. Counts as one execution.
  [[nodiscard]] std::vector<AddressedDeviation> alternatives(const AddressedSchedule& schedule,
                                                             const SearchFilter& filter, bool anywhere);

 private:
  /// What there is to know of an execution that was tried.
  struct Tried {
    Outcome outcome;
    std::uint64_t points = 0;
    std::uint64_t trace_hash = 0;
    std::uint64_t causal_hash = 0;
    std::vector<AddressedDeviation> alternatives = {};

    template <typename Carrier>
    friend void carry(Carrier& carrier, Tried& tried) {
      carrier(tried.outcome, tried.points, tried.trace_hash, tried.causal_hash, tried.alternatives);
    }
  };

  /// @return whether the failure came and was accepted
  [[nodiscard]] bool leads_to_failure(const AddressedSchedule& schedule);
  void run(const AddressedSchedule& schedule);

  // Of longer searches the rest is not looked at: memory.
  static constexpr std::size_t extended_max = std::size_t{1} << 17U;

  Explorer& explorer_;
  World& world_;
  const Scenario& scenario_;
  std::function<bool(const Outcome&)> is_the_failure_;
  Accept accept_;
  SearchBudget& budget_;
  AddressedStrategy strategy_;
  Tried last_;
};

}  // namespace ltsim
