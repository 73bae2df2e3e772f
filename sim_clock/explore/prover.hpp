// Runs all executions of a scenario within bounds, and says exactly what was covered.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/search_runner.hpp"
#include "sim_clock/explore/search_tree.hpp"

namespace ltsim {

struct ProveReport {
  SearchCounts counts;
  std::uint64_t states = 0;  ///< told apart, with ProofBounds::states; in each run anew
  unsigned runs = 1;         ///< one more than the search was interrupted and gone on with
  double done = 0;           ///< of the search, by what was known of it at the end: 0 to 1
  bool complete = false;     ///< all of it
  double seconds = 0;
  std::optional<Failure> failure;    ///< the search ends at the first; an interrupted one by workers, at any
  std::optional<std::string> error;  ///< why no result counts
  /// SearchTree::checkpoint(), if there is something to go on with.
  std::string checkpoint;
};

/// Called some ten times a second. @return false: stop
using ProveProgress = std::function<bool(const ProveReport&)>;

class Prover {
 public:
  explicit Prover(World& world) : world_(world) {}

  /// @param earlier  what was left of a search of the same scenario with the same options, with its checkpoint; {}: none
  [[nodiscard]] ProveReport prove(const Scenario& scenario, const ProveOptions& options,
                                  const ProveReport& earlier, const ProveProgress& on_progress);

 private:
  World& world_;
};

/// A search that is under way: what is known of it, and for how long it may go on.
class ProofUnderWay {
 public:
  /// @param earlier  as for Prover::prove()
  /// @throw Explorer::NotSimulable if its checkpoint is none
  ProofUnderWay(const ProveOptions& options, const ProveReport& earlier);

  [[nodiscard]] SearchTree& tree() noexcept { return tree_; }
  /// Whether the time is over, or `on_progress`, which is called now and then, has said so.
  /// @param states  that were told apart in this run
  [[nodiscard]] bool is_to_stop(const ProveProgress& on_progress, std::uint64_t states);
  /// @param runner  has been warmed up
  [[nodiscard]] ProveReport final_report(SearchRunner& runner) const;

 private:
  [[nodiscard]] ProveReport report(std::uint64_t states) const;

  using Clock = std::chrono::steady_clock;

  const ProveOptions& options_;
  double earlier_seconds_;
  std::uint64_t earlier_states_;
  unsigned runs_ = 1;
  SearchTree tree_;
  Clock::time_point began_at_ = Clock::now();
  Clock::time_point next_look_ = began_at_;
};

/// "at most 2 preemptions and at most 1 silence, memory c11"
[[nodiscard]] std::string describe_bounds(const ProveOptions& options);

/// What was run and within which bounds, and never more: "all 18432 executions with at most 2 preemptions and at most 1 silence, memory
/// c11; 0 cut off"
[[nodiscard]] std::string describe_coverage(const ProveReport& report, const ProveOptions& options);

}  // namespace ltsim
