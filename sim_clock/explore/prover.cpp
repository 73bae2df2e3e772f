#include "sim_clock/explore/prover.hpp"

#include <fmt/format.h>

#include "sim_clock/check/signal_guard.hpp"

namespace ltsim {
namespace {

/// "1 execution", "2 executions"
std::string counted(std::uint64_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

ProveReport Prover::prove(const Scenario& scenario, const ProveOptions& options, const ProveReport& earlier,
                          const std::function<bool(const ProveReport&)>& on_progress) {
  const SignalGuard signals;
  const auto begin = std::chrono::steady_clock::now();
  auto next_look = begin;
  Explorer explorer{world_};
  ExhaustiveStrategy strategy{world_, options.bounds};
  ProveReport report = earlier;
  if (!earlier.checkpoint.empty()) ++report.parts;
  if (!earlier.checkpoint.empty() && !strategy.resume(earlier.checkpoint)) {
    report.error = "the checkpoint holds a line that is none of a search";
    return report;
  }
  report.complete = false;
  report.failure.reset();
  world_.coverage().forget();
  world_.set_default_memory(options.memory);
  world_.set_default_cpu(Cpu::many);
  const auto fill = [&] {
    report.done = strategy.done();
    report.states = earlier.states + strategy.states();
    report.seconds =
        earlier.seconds + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  try {
    // What is initialised on first use must be so in all executions alike.
    ExhaustiveStrategy first{world_, {}};
    static_cast<void>(explorer.execute(scenario, first, 0, nullptr));
    if (options.bounds.states && world_.memory() == Memory::c11)
      throw Explorer::NotSimulable{
          "states are told apart with memory sc only: what of the past a weak memory "
          "still shows is no part of them"};
    if (world_.scheduler().cpu() != Cpu::many)
      throw Explorer::NotSimulable{"the scenario has one processor: which orders matter there, is not known"};
    for (bool goes_on = true; goes_on;) {
      static_cast<void>(explorer.execute(scenario, strategy, 0, nullptr));
      if (!strategy.trouble().empty()) throw Explorer::NotSimulable{strategy.trouble()};
      report.points += world_.scheduler().points();
      if (strategy.was_redundant()) {
        ++report.redundant;
      } else {
        ++report.executions;
        if (strategy.was_cut_off()) ++report.cut_off;
        if (strategy.was_held_back()) ++report.held_back;
      }
      if (!world_.scheduler().outcome().passed()) {
        Failure failure = explorer.record(scenario, strategy, 0);
        failure.execution = report.executions + report.redundant;
        failure.count = 1;
        std::vector<Failure> failures;
        ExploreOptions small;
        small.memory = options.memory;
        small.minimize_seconds = options.minimize_seconds;
        static_cast<void>(explorer.add_failure(scenario, small, failures, std::move(failure)));
        report.failure = std::move(failures.front());
        break;
      }
      report.complete = !strategy.advance();
      if (!strategy.trouble().empty()) throw Explorer::NotSimulable{strategy.trouble()};
      if (report.complete) break;
      if ((report.executions + report.redundant) % 64 != 0) continue;
      const auto now = std::chrono::steady_clock::now();
      if (options.seconds_max && now - begin >= *options.seconds_max) break;
      if (now < next_look) continue;
      next_look = now + std::chrono::milliseconds{100};
      fill();
      goes_on = on_progress(report);
    }
  } catch (const Explorer::NotSimulable& trouble) {
    report.complete = false;
    report.error = trouble.message;
  }
  fill();
  if (report.complete) report.done = 1;
  report.checkpoint = report.complete ? "" : strategy.checkpoint();
  return report;
}

std::string describe_bounds(const ProveOptions& options) {
  const ProofBounds& bounds = options.bounds;
  const std::string preemptions = bounds.preemptions ? "at most " + counted(*bounds.preemptions, "preemption")
                                                     : std::string{"any number of preemptions"};
  std::string silences = "any number of silences";
  if (bounds.silences) silences = *bounds.silences == 0 ? "no silence" : counted(*bounds.silences, "silence");
  const bool is_reduced = !bounds.preemptions && !bounds.states;
  return fmt::format("{} and {}{}, memory {}", preemptions, silences,
                     is_reduced ? ", one of each order that makes a difference" : "",
                     to_string(options.memory));
}

std::string describe_coverage(const ProveReport& report, const ProveOptions& options) {
  std::string states;
  if (options.bounds.states) {
    // A part has forgotten those of the parts before it.
    states = fmt::format("{}{} in ", counted(report.states, "state"),
                         report.parts == 1 ? "" : fmt::format(", told apart in {} parts,", report.parts));
  }
  const std::string held_back =
      report.held_back == 0 ? std::string{}
                            : fmt::format("; in {} of them a task that polled waited for a change after {}",
                                          report.held_back, counted(options.bounds.looks, "look"));
  return fmt::format("{}{}{} with {}; {} cut off{}", report.complete ? "all " : "", states,
                     counted(report.executions, "execution"), describe_bounds(options), report.cut_off,
                     held_back);
}

}  // namespace ltsim
