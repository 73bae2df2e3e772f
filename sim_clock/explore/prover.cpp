#include "sim_clock/explore/prover.hpp"

#include <utility>

#include <fmt/format.h>

#include "sim_clock/check/signal_guard.hpp"

namespace ltsim {
namespace {

/// "1 execution", "2 executions"
std::string counted(std::uint64_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

constexpr std::uint64_t executions_per_look_at_the_time = 8;

}  // namespace

ProofUnderWay::ProofUnderWay(const ProveOptions& options, const ProveReport& earlier)
    : options_(options), earlier_seconds_(earlier.seconds), earlier_states_(earlier.states) {
  if (earlier.checkpoint.empty()) return;
  runs_ = earlier.runs + 1;
  auto read = SearchTree::parse(earlier.checkpoint);
  if (!read) throw Explorer::NotSimulable{"the checkpoint holds a line that is none of a search"};
  tree_ = std::move(*read);
}

bool ProofUnderWay::is_to_stop(const ProveProgress& on_progress, std::uint64_t states) {
  const auto now = Clock::now();
  if (options_.seconds_max && now - began_at_ >= *options_.seconds_max) return true;
  if (now < next_look_) return false;
  next_look_ = now + std::chrono::milliseconds{100};
  return !on_progress(report(states));
}

ProveReport ProofUnderWay::report(std::uint64_t states) const {
  ProveReport report;
  report.states = earlier_states_ + states;
  report.runs = runs_;
  report.counts = tree_.counts();
  report.complete = tree_.is_complete();
  report.done = tree_.done();
  report.seconds = earlier_seconds_ + std::chrono::duration<double>(Clock::now() - began_at_).count();
  return report;
}

ProveReport ProofUnderWay::final_report(SearchRunner& runner) const {
  ProveReport final = report(runner.states());
  if (const SearchTree::Part* const ended = tree_.ended()) {
    if (SearchTree::end_of(*ended).end == SliceEnd::in_error) {
      final.error = SearchTree::end_of(*ended).error;
    } else {
      final.failure = runner.tell_failure(SearchTree::item_of(*ended));
      final.failure->execution = final.counts.executions + final.counts.redundant;
    }
  }
  if (!final.complete && !final.error) final.checkpoint = tree_.checkpoint();
  return final;
}

ProveReport Prover::prove(const Scenario& scenario, const ProveOptions& options, const ProveReport& earlier,
                          const ProveProgress& on_progress) try {
  const SignalGuard signals;
  ProofUnderWay proof{options, earlier};
  SearchRunner runner{world_, scenario, options};
  runner.warm_up();
  bool is_stopped = false;
  while (SearchTree::Part* const part = is_stopped ? nullptr : proof.tree().take()) {
    std::uint64_t executions = 0;
    SearchedSlice searched = runner.search(SearchTree::item_of(*part), [&](const SearchCounts& counts) {
      if (++executions % executions_per_look_at_the_time != 0) return true;
      SearchTree::note_progress(*part, counts, runner.done());
      is_stopped = proof.is_to_stop(on_progress, runner.states());
      return !is_stopped;
    });
    proof.tree().give_back(*part, std::move(searched), false);
  }
  return proof.final_report(runner);
} catch (const Explorer::NotSimulable& trouble) {
  ProveReport report = earlier;
  report.checkpoint.clear();
  report.error = trouble.message;
  return report;
}

std::string describe_bounds(const ProveOptions& options) {
  const ProofBounds& bounds = options.bounds;
  const std::string preemptions = bounds.preemptions ? "at most " + counted(*bounds.preemptions, "preemption")
                                                     : std::string{"any number of preemptions"};
  std::string silences = "any number of silences";
  if (bounds.silences) silences = *bounds.silences == 0 ? "no silence" : counted(*bounds.silences, "silence");
  const bool is_reduced = !bounds.preemptions && !bounds.states;
  return fmt::format("{} and {}{}, memory {}{}{}", preemptions, silences,
                     is_reduced ? ", one of each order that makes a difference" : "",
                     to_string(options.memory), options.findings.races ? "" : ", races off",
                     options.findings.leaks ? "" : ", leaks off");
}

std::string describe_coverage(const ProveReport& report, const ProveOptions& options) {
  std::string states;
  if (options.bounds.states) {
    // A run has forgotten those of the runs before it.
    states = fmt::format("{}{} in ", counted(report.states, "state"),
                         report.runs == 1 ? "" : fmt::format(", told apart in {} runs,", report.runs));
  }
  const std::string held_back =
      report.counts.held_back == 0
          ? std::string{}
          : fmt::format("; in {} of them a task that polled waited for a change after {}",
                        report.counts.held_back, counted(options.bounds.looks, "look"));
  return fmt::format("{}{}{} with {}; {} cut off{}", report.complete ? "all " : "", states,
                     counted(report.counts.executions, "execution"), describe_bounds(options),
                     report.counts.cut_off, held_back);
}

}  // namespace ltsim
