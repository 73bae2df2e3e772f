// Runs a scenario again and again under a strategy and reports how it failed.
//
// What fails is made as small as the time given for it allows; then failures that differ in numbers of their
// message only, and need the same means, are one (same_failure.hpp).
//
// The first execution that fails in a new way is run a second time, with the same seed, to write its schedule
// down; and of those that pass the 1st, 2nd, 4th, 8th ... are run twice as well. Two runs of a seed that
// differ mean that something survived from one execution to the next or came from outside: nothing that was
// found would be worth anything, so exploration stops.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim_clock/check/outcome.hpp"
#include "sim_clock/check/source_locations.hpp"
#include "sim_clock/explore/forked_work.hpp"
#include "sim_clock/explore/replay_strategy.hpp"
#include "sim_clock/explore/schedule.hpp"
#include "sim_clock/explore/start_state.hpp"
#include "sim_clock/explore/strategy.hpp"
#include "sim_clock/scenario/scenario.hpp"

namespace ltsim {

struct ExploreOptions {
  std::uint64_t seed = 1;
  std::uint64_t executions_max = 100'000;
  std::optional<std::chrono::duration<double>> seconds_max;  ///< of real time; looked at every 64 executions
  Memory memory = Memory::sc;                                ///< unless the scenario says otherwise
  Cpu cpu = Cpu::many;  ///< of the machine, unless the scenario says otherwise
  Findings findings = {};
  StartState start_state = StartState::restore;
  bool keep_going = false;  ///< go on after a failure and report each different one once
  /// Real time for making the schedule of each different failure small; 0: it stays as it was recorded.
  std::chrono::duration<double> minimize_seconds{0};
};

struct Failure {
  Outcome outcome;              ///< of `schedule`
  std::uint64_t execution = 0;  ///< the first that failed so; 1 is the first of the exploration
  std::uint64_t seed = 0;       ///< of that execution
  std::uint64_t count = 0;      ///< executions that failed so
  std::uint64_t trace_hash = 0;
  SimTime at{0};
  Schedule schedule;
  std::size_t choices_count = 0;      ///< that differed from the default in the execution itself
  bool one_minimal = false;           ///< without any one line of the schedule the failure is gone
  std::string story;                  ///< of `schedule`, for a screen; empty where it was not made small
  std::string output;                 ///< what the code under test has written meanwhile
  std::vector<std::string> messages;  ///< of all executions that count as this failure
  bool has_schedule = true;           ///< false: the process died, and the choices with it
};

/// See carried_bytes.hpp.
template <typename Carrier>
void carry(Carrier& carrier, Failure& failure) {
  carrier(failure.outcome, failure.execution, failure.seed, failure.count, failure.trace_hash, failure.at,
          failure.schedule, failure.choices_count, failure.one_minimal, failure.story, failure.output,
          failure.messages, failure.has_schedule);
}

struct ExecutionResult {
  std::uint64_t trace_hash = 0;
  std::uint64_t decisions = 0;
  std::uint64_t points = 0;
  std::size_t failure = 0;  ///< its place, from 1, among the failures known; 0: passed, or not known yet
};

struct ExploreReport {
  std::uint64_t executions = 0;
  std::uint64_t decisions = 0;
  std::uint64_t points = 0;
  double seconds = 0;
  std::uint64_t distinct_schedules = 0;  ///< different traces; a lower bound beyond distinct_schedules_max
  std::vector<Failure> failures;
};

struct ReplayReport {
  Outcome outcome;
  std::uint64_t trace_hash = 0;
  SimTime at{0};
  std::optional<ReplayStrategy::Divergence> divergence;
};

class Explorer {
 public:
  static constexpr std::size_t distinct_schedules_max = std::size_t{1} << 22U;

  /// Thrown when two runs of one seed differ, or the code under test does what the world cannot simulate: no
  /// result of the exploration counts then.
  struct NotSimulable {
    std::string message;
  };

  explicit Explorer(World& world) : world_(world) {}

  /// StartState::restore at first. With StartState::fork the world of this process sees no execution: what there is to know of one is what
  /// the functions here return.
  void set_start_state(StartState state);
  [[nodiscard]] StartState start_state() const noexcept {
    return forks_ ? StartState::fork : StartState::restore;
  }

  /// Seed of the `execution`-th execution of an exploration, from 1.
  [[nodiscard]] static std::uint64_t seed_of(std::uint64_t exploration_seed,
                                             std::uint64_t execution) noexcept;

  [[nodiscard]] ExploreReport explore(const Scenario& scenario, Strategy& strategy,
                                      const ExploreOptions& options);

  /// Execution number `execution` of an exploration: runs it, and checks some for being repeatable. The caller
  /// holds a SignalGuard.
  /// @param fresh  gets the failure if it is not among `failures` yet: the result names it after add_failure()
  [[nodiscard]] ExecutionResult explore_one(const Scenario& scenario, Strategy& strategy,
                                            const ExploreOptions& options, std::uint64_t execution,
                                            std::vector<Failure>& failures, std::optional<Failure>& fresh);
  /// Makes the failure small and adds it to those known, or to the one among them that it is.
  /// @return its place among them, from 1
  [[nodiscard]] std::size_t add_failure(const Scenario& scenario, const ExploreOptions& options,
                                        std::vector<Failure>& failures, Failure failure);

  /// Runs one execution and writes its choices down.
  [[nodiscard]] Failure record(const Scenario& scenario, Strategy& strategy, std::uint64_t seed);

  /// In this process, so with StartState::fork once in a process.
  /// @param listener  is told every step; may be null
  [[nodiscard]] ReplayReport replay(const Scenario& scenario, const Schedule& schedule,
                                    StepListener* listener);

  /// Work that runs one execution, by execute(), and returns what is to be known of it: in a process of its own where that is asked for.
  /// @param work  returns what can be carried (carried_bytes.hpp); what else it changes may be lost
  template <typename Result>
  Result apart(const std::function<Result()>& work) {
    if (!forks_) return work();
    const std::size_t known = sites_looked_up().size();
    auto found = forks_->run<WithSites<Result>, NotSimulable>([&] {
      Result result = work();
      const auto sites = sites_looked_up().subspan(known);
      return WithSites<Result>{.result = std::move(result), .sites = {sites.begin(), sites.end()}};
    });
    if (!found.sites.empty()) look_up(found.sites);
    return std::move(found.result);
  }

  /// Runs one execution, in this process. @return its trace hash
  std::uint64_t execute(const Scenario& scenario, Strategy& strategy, std::uint64_t seed,
                        StepListener* listener);

 private:
  /// What is to be known of an execution that counts.
  struct Ended {
    Outcome outcome;
    ExecutionResult result;
    std::uint64_t new_states = 0;
    std::size_t tasks = 0;

    template <typename Carrier>
    friend void carry(Carrier& carrier, Ended& ended) {
      carrier(ended.outcome, ended.result, ended.new_states, ended.tasks);
    }
  };

  /// What work has come to, and the places in the code that were looked up for it.
  template <typename Result>
  struct WithSites {
    Result result;
    std::vector<std::uint32_t> sites;

    template <typename Carrier>
    friend void carry(Carrier& carrier, WithSites& found) {
      carrier(found.result, found.sites);
    }
  };

  /// Here as well: those that are forked from now on know them, and need not read the debug information again.
  static void look_up(const std::vector<std::uint32_t>& sites);

  [[nodiscard]] Ended run(const Scenario& scenario, Strategy& strategy, std::uint64_t seed);
  [[nodiscard]] Failure record_here(const Scenario& scenario, Strategy& strategy, std::uint64_t seed);
  /// Runs one execution. @return its trace, as text
  [[nodiscard]] std::string trace(const Scenario& scenario, Strategy& strategy, std::uint64_t seed);
  void minimize(const Scenario& scenario, Failure& failure, std::chrono::duration<double> seconds);
  /// Whether the seed gives this trace again, or has come to give another one for good.
  [[nodiscard]] bool repeats(const Scenario& scenario, Strategy& strategy, std::uint64_t seed,
                             std::uint64_t hash);
  /// Runs the seed again, twice, to say where the runs part.
  [[nodiscard]] NotSimulable not_repeatable(const Scenario& scenario, Strategy& strategy, std::uint64_t seed);

  World& world_;
  std::unique_ptr<ForkedWork> forks_;
};

}  // namespace ltsim
