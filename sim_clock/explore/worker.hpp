// One worker of an exploration: a process that runs its share of the executions, each in its own World.
#pragma once

#include <csignal>
#include <functional>
#include <memory>

#include "sim_clock/explore/worker_progress.hpp"

namespace ltsim {

using StrategyFactory = std::function<std::unique_ptr<Strategy>()>;

/// What one process is to do.
struct WorkerOrder {
  const Scenario& scenario;
  const StrategyFactory& make_strategy;
  const ExploreOptions& options;
  unsigned number = 0;  ///< from 0
  unsigned workers_count = 1;
  std::size_t failures_sent = 0;  ///< by its predecessors of the same number

  [[nodiscard]] std::uint64_t execution_of(std::uint64_t index) const noexcept {
    return 1 + number + index * workers_count;
  }
};

/// The signal with which the parent asks for WorkerProgress::position.
inline constexpr int worker_position_signal = SIGUSR1;

/// Runs in a process just forked, in which no World exists. @param socket  for messages to the parent
void run_worker(const WorkerOrder& order, SharedProgress& progress, int socket) noexcept;

}  // namespace ltsim
