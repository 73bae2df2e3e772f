#include "sim_clock/explore/prove_in_workers.hpp"

#include <poll.h>

#include <algorithm>
#include <csignal>
#include <deque>
#include <optional>

#include <fmt/format.h>

#include "sim_clock/check/self_check.hpp"
#include "sim_clock/check/signal_guard.hpp"
#include "sim_clock/explore/frames.hpp"
#include "sim_clock/explore/worker_pool.hpp"
#include "sim_clock/explore/worker_process.hpp"

namespace ltsim {
namespace {

using Clock = std::chrono::steady_clock;

/// How often the parent looks up when nothing arrives.
constexpr std::chrono::milliseconds look_interval{20};
/// What a part gets to come to its next execution in, after the user has asked to stop.
constexpr std::chrono::seconds stop_grace{1};

SearchedSlice in_error(std::string message) {
  SearchedSlice slice;
  slice.end = SliceEnd::in_error;
  slice.error = std::move(message);
  return slice;
}

/// Runs in a worker: searches what it is sent, until nothing is sent any more.
void search_parts(const Scenario& scenario, const ProveOptions& options, std::chrono::duration<double> slice,
                  int socket) {
  World world;
  const SignalGuard signals;
  SearchRunner runner{world, scenario, options};
  FrameReader reader;
  bool is_warm = false;
  while (const auto text = read_text(socket, reader)) {
    SearchedSlice searched;
    try {
      if (!is_warm) runner.warm_up();
      is_warm = true;
      const auto item = parse_item(*text);
      LTSIM_CHECK(item.has_value());
      const auto until = Clock::now() + slice;
      searched = runner.search(*item, [&](const SearchCounts&) { return Clock::now() < until; });
    } catch (const Explorer::NotSimulable& trouble) {
      searched = in_error(trouble.message);
    }
    if (!write_text(socket, to_text(searched))) return;
  }
}

struct ProofWorker {
  std::optional<WorkerProcess> process;
  FrameReader frames;
  SearchTree::Part* part = nullptr;  // that it is at
};

class ProofWorkers {
 public:
  ProofWorkers(const Scenario& scenario, const ProveOptions& options, const ProveWorkersOptions& workers,
               ProofUnderWay& proof)
      : proof_(proof) {
    for (unsigned i = 0; i < workers.jobs; ++i) {
      workers_.emplace_back().process.emplace(
          [&](int socket) { search_parts(scenario, options, workers.slice, socket); });
    }
  }

  /// @return why the proof cannot go on, if it cannot
  std::optional<std::string> run(const ProveProgress& on_progress) {
    std::optional<Clock::time_point> stopped_at;
    while (!death_ && !proof_.tree().is_over()) {
      if (!stopped_at && proof_.is_to_stop(on_progress, 0)) stopped_at = Clock::now();
      if (stopped_at && (!is_any_at_work() || Clock::now() - *stopped_at >= stop_grace)) break;
      if (!stopped_at) hand_out();
      wait_for_slices();
      for (ProofWorker& worker : workers_) take_slice(worker);
    }
    return death_;
  }

 private:
  [[nodiscard]] bool is_any_at_work() const {
    return std::any_of(workers_.begin(), workers_.end(),
                       [](const ProofWorker& worker) { return worker.part != nullptr; });
  }

  void hand_out() {
    for (ProofWorker& worker : workers_) {
      if (worker.part != nullptr) continue;
      worker.part = proof_.tree().take();
      if (worker.part == nullptr) return;
      // If it is dead, that is noticed soon.
      static_cast<void>(write_text(worker.process->descriptor(), to_text(SearchTree::item_of(*worker.part))));
    }
  }

  void wait_for_slices() {
    std::vector<pollfd> descriptors;
    for (const ProofWorker& worker : workers_)
      descriptors.push_back({.fd = worker.process->descriptor(), .events = POLLIN, .revents = 0});
    poll(descriptors.data(), descriptors.size(), static_cast<int>(look_interval.count()));
  }

  void take_slice(ProofWorker& worker) {
    worker.frames.add(worker.process->receive());
    if (const auto frame = worker.frames.next()) {
      auto slice = parse_slice(std::string{frame->begin(), frame->end()});
      LTSIM_CHECK(slice.has_value() && worker.part != nullptr);
      proof_.tree().give_back(*std::exchange(worker.part, nullptr), std::move(*slice), true);
    } else if (worker.process->has_ended() && !death_) {
      death_ = fmt::format("a worker process {}: the part of the search that it was at is still to be done",
                           describe_end(worker.process->wait()));
    }
  }

  ProofUnderWay& proof_;
  std::deque<ProofWorker> workers_;  // they stay where they are
  std::optional<std::string> death_;
};

}  // namespace

ProveReport prove_in_workers(const Scenario& scenario, const ProveOptions& options,
                             const ProveWorkersOptions& workers, const ProveReport& earlier,
                             const ProveProgress& on_progress) try {
  LTSIM_CHECK(workers.jobs >= 1 && workers.jobs <= WorkerPoolOptions::jobs_max && !options.bounds.states);
  ProofUnderWay proof{options, earlier};
  const auto death = ProofWorkers{scenario, options, workers, proof}.run(on_progress);
  // Only now: the workers would share its segments.
  World world;
  const SignalGuard signals;
  SearchRunner runner{world, scenario, options};
  if (const SearchTree::Part* const ended = proof.tree().ended();
      ended != nullptr && SearchTree::end_of(*ended).end == SliceEnd::failed)
    runner.warm_up();
  ProveReport report = proof.final_report(runner);
  if (death && !report.error) report.error = *death;
  return report;
} catch (const Explorer::NotSimulable& trouble) {
  ProveReport report = earlier;
  report.checkpoint.clear();
  report.error = trouble.message;
  return report;
}

}  // namespace ltsim
