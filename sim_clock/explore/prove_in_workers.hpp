// A proof in worker processes: each searches parts of the search tree (search_tree.hpp), one at a time and for a short while, and
// tells what it has found. The report is the one of Prover, whatever the number of workers.
//
// A worker that dies ends the proof: the part that it was at stands in the checkpoint as it was before. One that hangs does so until
// the user wants to stop; then it is killed, and its part stands as it was before, too.
//
// The workers are forked, so no World may exist in the process that proves, nor a second thread.
#pragma once

#include <chrono>

#include "sim_clock/explore/prover.hpp"

namespace ltsim {

struct ProveWorkersOptions {
  unsigned jobs = 1;  ///< worker processes, 1 to WorkerPoolOptions::jobs_max
  /// How long a worker is at a part before others get what is left of it. 0: one execution.
  std::chrono::duration<double> slice = std::chrono::milliseconds{50};
};

/// As Prover::prove(). Not with ProofBounds::states.
/// @throw std::system_error if a process cannot be had
[[nodiscard]] ProveReport prove_in_workers(const Scenario& scenario, const ProveOptions& options,
                                           const ProveWorkersOptions& workers, const ProveReport& earlier,
                                           const ProveProgress& on_progress);

}  // namespace ltsim
