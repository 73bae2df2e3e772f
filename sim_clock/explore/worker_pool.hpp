// Explores a scenario in worker processes, so that an execution which kills or hangs its process takes nothing
// else with it, and so that every processor has something to do.
//
// The executions are dealt out in turn (worker_progress.hpp) with the seeds of Explorer::seed_of(), and only
// those up to the end of the exploration count: the first failure is the one with the lowest number, also if
// another worker was faster with a later one. So the report depends on the seed and the number of workers,
// not on time; unless a time limit, a signal from outside or a hang ends something. With a strategy that
// learns, each worker learns from its own executions.
//
// A worker that dies has its execution reported as `crash`, one that makes no progress for long is killed and
// its execution reported as `livelock`; another worker goes on after that execution. What such an execution
// chose is not known: the same exploration comes to it again.
//
// The workers are forked, so no World may exist in the process that explores, nor a second thread.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/worker.hpp"

namespace ltsim {

struct ExploreProgress {
  std::uint64_t executions = 0;
  std::uint64_t failures = 0;  ///< messages about failures so far; some may be the same one
  std::chrono::duration<double> elapsed{0};
};

struct WorkerPoolOptions {
  unsigned jobs = 1;  ///< worker processes, 1 to jobs_max
  /// A worker that passes no scheduling point for so long hangs.
  std::chrono::duration<double> hang_after = std::chrono::seconds{10};
  /// Called some ten times a second. @return false: stop, and report what has been found
  std::function<bool(const ExploreProgress&)> on_progress;

  static constexpr unsigned jobs_max = 256;
};

struct WorkerPoolReport {
  ExploreReport explored;  ///< failures in the order of their executions
  /// The exploration stopped because of this, which is no finding: what Explorer::NotSimulable says, or an
  /// error of the simulator itself.
  std::optional<std::string> error;
  bool stopped = false;                  ///< by on_progress
  std::vector<std::uint64_t> abandoned;  ///< executions that did not end soon after that, and were killed
};

/// @throw std::system_error if a process or its memory cannot be had
[[nodiscard]] WorkerPoolReport explore_in_workers(const Scenario& scenario,
                                                  const StrategyFactory& make_strategy,
                                                  const ExploreOptions& options,
                                                  const WorkerPoolOptions& pool);

}  // namespace ltsim
