// Makes of a schedule that fails the smallest one that fails in the same way.
//
// Stages, each within what the ones before have left of the budget:
//   1  lines are left out, many at once and then one by one, as long as the failure stays (delta debugging);
//      where time passes again and again, as for a peer that polls, one silence of who was held up is tried for
//      all of it;
//      the records of an input that the scenario reads likewise, and then bytes of those that are left;
//   2  whatever was found by then, shorter schedules are searched for (schedule_search.hpp), first among
//      deviations like those that are left, then among all;
//   3  of equivalent places for a line the one is taken that is most likely to survive a rebuild;
//   4  durations become the smallest round ones, and answers the smallest;
//   5  each line is left out once more: where none can be, the schedule is 1-minimal.
//
// The result always replays, by its anchors, to the failure. When the budget ends early, it is the best so far.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/schedule_search.hpp"
#include "sim_clock/explore/search_budget.hpp"
#include "sim_clock/explore/silence_watch.hpp"

namespace ltsim {

struct MinimizeOptions {
  std::chrono::duration<double> seconds_max{2.0};  ///< of real time
  std::uint64_t executions_max = SearchBudget::unlimited;
  std::uint64_t points_max = SearchBudget::unlimited;  ///< scheduling points of all executions together
  /// Whether a line must stay without which the failure's message holds other numbers.
  bool numbers_matter = true;
};

struct MinimizeReport {
  bool reproduced = false;  ///< the given schedule fails as it says; otherwise it is handed back as it was
  Schedule schedule;        ///< the best found
  Outcome outcome;
  std::uint64_t trace_hash = 0;
  SimTime at{0};
  bool one_minimal = false;  ///< without any one of the lines the failure is gone: tried, line by line
  bool smallest = false;     ///< the search for a shorter one came to its end
  std::uint64_t executions = 0;
};

class Minimizer {
 public:
  Minimizer(World& world, const Scenario& scenario)
      : world_(world), own_explorer_(world), explorer_(*own_explorer_), scenario_(scenario) {}
  /// @param explorer  runs the executions, in `world`
  Minimizer(Explorer& explorer, World& world, const Scenario& scenario)
      : world_(world), explorer_(explorer), scenario_(scenario) {}

  [[nodiscard]] MinimizeReport minimize(const Schedule& failing, const MinimizeOptions& options);

 private:
  /// A schedule that was seen to end in the failure, and how.
  struct Attempt {
    std::vector<Deviation> deviations;  ///< those really carried out
    AddressedSchedule addressed;        ///< the same, by address
    Outcome outcome;
    std::uint64_t trace_hash = 0;
    SimTime at{0};

    template <typename Carrier>
    friend void carry(Carrier& carrier, Attempt& attempt) {
      carrier(attempt.deviations, attempt.addressed, attempt.outcome, attempt.trace_hash, attempt.at);
    }
  };
  /// What there is to know of an execution that was tried.
  struct Tried {
    std::optional<Attempt> failure;  ///< it ended in the failure
    std::uint64_t points = 0;
    std::vector<SilenceWatch::Silence> silences = {};  ///< where they were asked for

    template <typename Carrier>
    friend void carry(Carrier& carrier, Tried& tried) {
      carrier(tried.failure, tried.points, tried.silences);
    }
  };

  /// Replays. @return nothing if that does not end in the failure
  [[nodiscard]] std::optional<Attempt> attempt(const std::vector<Deviation>& deviations);
  /// The same from addresses; what comes back is sure to replay by its anchors.
  [[nodiscard]] std::optional<Attempt> attempt(const AddressedSchedule& addressed);
  [[nodiscard]] std::optional<Attempt> tried(Tried&& tried);
  [[nodiscard]] Tried record(Strategy& strategy, AnchorTracker& anchors);

  /// @return whether each line was found to be needed
  bool leave_out_lines();
  /// Leaves out records of the world's input, then bytes within those that stay.
  /// @return whether each record was found to be needed
  bool leave_out_input();
  /// @return whether that input fails, too; the world keeps it then, and has the old one again otherwise
  bool still_fails_with_input(std::vector<std::string> records);
  /// Puts silences of those who were held up in place of the lines that let time pass for everybody, one for all
  /// the lines in a row. @return whether that fails too, with fewer lines
  bool join_slow_moments();
  /// @return whether no shorter schedule exists among those that were to be tried
  bool search_for_shorter();
  void strengthen_anchors();
  void strengthen_anchor(std::size_t line);
  void shrink_magnitudes();
  void shrink_duration(std::size_t line);
  bool still_fails_with(std::size_t line, const Deviation& changed);

  [[nodiscard]] bool has_budget(double until) const noexcept { return budget_->used() < until; }

  World& world_;
  std::optional<Explorer> own_explorer_;
  Explorer& explorer_;
  const Scenario& scenario_;
  std::function<bool(const Outcome&)> is_the_failure_;
  SearchBudget* budget_ = nullptr;
  Attempt best_;
};

}  // namespace ltsim
