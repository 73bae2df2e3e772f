// Runs all executions of a scenario within bounds, and says exactly what was covered.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "sim_clock/explore/exhaustive_strategy.hpp"
#include "sim_clock/explore/explorer.hpp"

namespace ltsim {

struct ProveOptions {
  ProofBounds bounds;
  Memory memory = Memory::sc;
  std::optional<std::chrono::duration<double>> seconds_max;  ///< of real time
  std::chrono::duration<double> minimize_seconds{0};
};

struct ProveReport {
  std::uint64_t executions = 0;  ///< that went to their end; redundant ones do not count
  std::uint64_t redundant = 0;   ///< left when they came to nothing new
  std::uint64_t cut_off = 0;     ///< of `executions`: longer than ExhaustiveStrategy::steps_max
  std::uint64_t held_back = 0;   ///< of `executions`: ProofBounds::looks made a polling task wait
  std::uint64_t states = 0;      ///< told apart, with ProofBounds::states; in each part of the search anew
  unsigned parts = 1;            ///< one more than the search was interrupted and gone on with
  std::uint64_t points = 0;
  double done = 0;        ///< of the search, by what was known of it at the end: 0 to 1
  bool complete = false;  ///< all of it
  double seconds = 0;
  std::optional<Failure> failure;    ///< the search ends at the first
  std::optional<std::string> error;  ///< why no result counts
  std::string checkpoint;            ///< where to go on, unless it is complete
};

class Prover {
 public:
  explicit Prover(World& world) : world_(world) {}

  /// @param earlier      what was left of a search of the same scenario with the same options, with its checkpoint; {}: none
  /// @param on_progress  called some ten times a second. @return false: stop
  [[nodiscard]] ProveReport prove(const Scenario& scenario, const ProveOptions& options,
                                  const ProveReport& earlier,
                                  const std::function<bool(const ProveReport&)>& on_progress);

 private:
  World& world_;
};

/// "at most 2 preemptions and 1 silence, memory c11"
[[nodiscard]] std::string describe_bounds(const ProveOptions& options);

/// What was run and within which bounds, and never more: "all 18432 executions with at most 2 preemptions and 1 silence, memory
/// c11; 0 cut off"
[[nodiscard]] std::string describe_coverage(const ProveReport& report, const ProveOptions& options);

}  // namespace ltsim
