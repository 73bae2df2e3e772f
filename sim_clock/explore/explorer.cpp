#include "sim_clock/explore/explorer.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "sim_clock/check/program_symbols.hpp"
#include "sim_clock/check/signal_guard.hpp"
#include "sim_clock/explore/hash_set.hpp"
#include "sim_clock/explore/minimizer.hpp"
#include "sim_clock/explore/random_generator.hpp"
#include "sim_clock/explore/recording_strategy.hpp"
#include "sim_clock/explore/same_failure.hpp"
#include "sim_clock/trace/story.hpp"
#include "sim_clock/trace/text_trace.hpp"

namespace ltsim {
namespace {

/// Among those known; null if it is a new one.
Failure* find_failure(std::vector<Failure>& failures, const Outcome& outcome) {
  for (Failure& failure : failures) {
    if (failure.outcome.kind == outcome.kind && is_known_message(failure, outcome.message)) return &failure;
  }
  return nullptr;
}

/// The first line in which two texts differ, of both.
std::string first_difference(std::string_view one, std::string_view other) {
  while (!one.empty() || !other.empty()) {
    const std::string_view a = one.substr(0, one.find('\n'));
    const std::string_view b = other.substr(0, other.find('\n'));
    if (a != b) return fmt::format("first \"{}\", then \"{}\"", a, b);
    one.remove_prefix(std::min(a.size() + 1, one.size()));
    other.remove_prefix(std::min(b.size() + 1, other.size()));
  }
  return "only the very first run differed";
}

std::string_view why_runs_differ(const Scenario& scenario, StartState state) {
  if (state == StartState::fork)
    return "each had a process of its own, so the difference came from outside: a file, another process, the "
           "machine";
  if (scenario.program.empty())
    return "a variable of the code under test or of the scenario survives from one execution to the next";
  return "the program's memory was put back between them, but not what libraries keep for themselves, nor "
         "files; \"--state fork\" gives each execution a process of its own";
}

}  // namespace

std::uint64_t Explorer::seed_of(std::uint64_t exploration_seed, std::uint64_t execution) noexcept {
  return splitmix64(splitmix64(exploration_seed) + execution);
}

std::uint64_t Explorer::execute(const Scenario& scenario, Strategy& strategy, std::uint64_t seed,
                                StepListener* listener) {
  strategy.begin_execution(seed);
  world_.reset(strategy, listener);
  try {
    if (strategy.looks_at_states()) {
      world_.whole_state().run(scenario.body);
    } else {
      scenario.body(world_);
    }
  } catch (const World::Abandoned&) {
    // It has ended where the strategy let it end.
  }
  world_.end_execution();
  world_.whole_state().end();
  if (world_.scheduler().run_is_missing()) {
    throw NotSimulable{fmt::format("{} makes tasks and never calls World::run()", scenario.name)};
  }
  if (world_.scheduler().outcome().kind == OutcomeKind::unsupported) {
    throw NotSimulable{world_.scheduler().outcome().message};
  }
  return world_.scheduler().trace_hash();
}

ExecutionResult Explorer::explore_one(const Scenario& scenario, Strategy& strategy,
                                      const ExploreOptions& options, std::uint64_t execution,
                                      std::vector<Failure>& failures, std::optional<Failure>& fresh) {
  const std::uint64_t seed = seed_of(options.seed, execution);
  const Ended ended = run(scenario, strategy, seed);
  ExecutionResult result = ended.result;
  const std::uint64_t hash = result.trace_hash;
  ExecutionSummary summary{.points = result.points, .new_states = ended.new_states};
  if (ended.outcome.passed()) {
    if (std::has_single_bit(execution) && !repeats(scenario, strategy, seed, hash)) {
      throw not_repeatable(scenario, strategy, seed);
    }
  } else if (Failure* const known = find_failure(failures, ended.outcome)) {
    ++known->count;
    result.failure = static_cast<std::size_t>(known - failures.data()) + 1;
  } else {
    fresh = record(scenario, strategy, seed);
    const bool settled = fresh->trace_hash == hash || repeats(scenario, strategy, seed, fresh->trace_hash);
    if (!settled || fresh->outcome.passed()) throw not_repeatable(scenario, strategy, seed);
    fresh->execution = execution;
    fresh->count = 1;
    summary.failed_anew = true;
  }
  strategy.learn(summary);
  return result;
}

std::size_t Explorer::add_failure(const Scenario& scenario, const ExploreOptions& options,
                                  std::vector<Failure>& failures, Failure failure) {
  if (options.minimize_seconds.count() > 0) minimize(scenario, failure, options.minimize_seconds);
  for (std::size_t i = 0; i < failures.size(); ++i) {
    if (!is_same_failure(failures[i], failure)) continue;
    ++failures[i].count;
    failures[i].messages.insert(failures[i].messages.end(), failure.messages.begin(), failure.messages.end());
    return i + 1;
  }
  failures.push_back(std::move(failure));
  return failures.size();
}

ExploreReport Explorer::explore(const Scenario& scenario, Strategy& strategy, const ExploreOptions& options) {
  const SignalGuard signals;
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin);
  };
  constexpr std::uint64_t executions_per_look_at_the_time = 64;
  ExploreReport report;
  HashSet traces{distinct_schedules_max};
  world_.coverage().forget();
  world_.set_default_memory(options.memory);
  world_.set_default_cpu(options.cpu);
  world_.set_findings(options.findings);
  while (report.executions < options.executions_max) {
    if (options.seconds_max && report.executions % executions_per_look_at_the_time == 0 &&
        elapsed() >= *options.seconds_max) {
      break;
    }
    ++report.executions;
    std::optional<Failure> fresh;
    const ExecutionResult result =
        explore_one(scenario, strategy, options, report.executions, report.failures, fresh);
    report.decisions += result.decisions;
    report.points += result.points;
    traces.insert(result.trace_hash);
    if (fresh) static_cast<void>(add_failure(scenario, options, report.failures, std::move(*fresh)));
    if ((fresh || result.failure != 0) && !options.keep_going) break;
  }
  report.seconds = elapsed().count();
  report.distinct_schedules = traces.size();
  return report;
}

Explorer::Ended Explorer::run(const Scenario& scenario, Strategy& strategy, std::uint64_t seed) {
  Ended ended = apart<Ended>([&] {
    const std::uint64_t hash = execute(scenario, strategy, seed, nullptr);
    const Scheduler& scheduler = world_.scheduler();
    return Ended{
        .outcome = scheduler.outcome(),
        .result = {.trace_hash = hash, .decisions = scheduler.decisions(), .points = scheduler.points()},
        .new_states = world_.coverage().new_in_execution(),
        .tasks = scheduler.tasks_count()};
  });
  if (forks_) world_.scheduler().pool_tasks(ended.tasks);
  return ended;
}

void Explorer::set_start_state(StartState state) {
  forks_ = nullptr;
  if (state != StartState::fork) return;
  forks_ = std::make_unique<ForkedWork>();
  read_symbols();
}

void Explorer::look_up(const std::vector<std::uint32_t>& sites) {
  for (const std::uint32_t site : sites) static_cast<void>(source_location(site));
}

bool Explorer::repeats(const Scenario& scenario, Strategy& strategy, std::uint64_t seed, std::uint64_t hash) {
  const std::uint64_t second = run(scenario, strategy, seed).result.trace_hash;
  // The first run may have come where something is initialised on first use. After that every run must be
  // like the last.
  return second == hash || run(scenario, strategy, seed).result.trace_hash == second;
}

std::string Explorer::trace(const Scenario& scenario, Strategy& strategy, std::uint64_t seed) {
  return apart<std::string>([&] {
    TextTrace trace{world_};
    execute(scenario, strategy, seed, &trace);
    return trace.text();
  });
}

Explorer::NotSimulable Explorer::not_repeatable(const Scenario& scenario, Strategy& strategy,
                                                std::uint64_t seed) {
  const std::string one = trace(scenario, strategy, seed);
  const std::string other = trace(scenario, strategy, seed);
  return {fmt::format("two runs of seed {} of {} differ: {}. Where: {}", seed, scenario.name,
                      why_runs_differ(scenario, start_state()), first_difference(one, other))};
}

Failure Explorer::record(const Scenario& scenario, Strategy& strategy, std::uint64_t seed) {
  return apart<Failure>([&] { return record_here(scenario, strategy, seed); });
}

Failure Explorer::record_here(const Scenario& scenario, Strategy& strategy, std::uint64_t seed) {
  AnchorTracker anchors{world_, nullptr};
  RecordingStrategy recording{strategy, world_, anchors};
  const std::uint64_t hash = execute(scenario, recording, seed, &anchors);
  const Outcome& outcome = world_.scheduler().outcome();
  return Failure{.outcome = outcome,
                 .seed = seed,
                 .trace_hash = hash,
                 .at = world_.now(),
                 .schedule = {.scenario = std::string{scenario.name},
                              .outcome = outcome.kind,
                              .message = one_line(outcome.message),
                              .memory = world_.memory(),
                              .cpu = world_.scheduler().cpu(),
                              .findings = world_.findings(),
                              .start_state = start_state(),
                              .input = world_.input_records(),
                              .program = scenario.program,
                              .deviations = recording.deviations()},
                 .choices_count = recording.deviations().size(),
                 .story = {},
                 .output = world_.output(),
                 .messages = {outcome.message}};
}

void Explorer::minimize(const Scenario& scenario, Failure& failure, std::chrono::duration<double> seconds) {
  // What a core does: so the end seldom depends on how busy the machine is.
  constexpr double points_per_second = 20e6;
  constexpr double forks_per_second = 1000;
  const MinimizeReport report = Minimizer{*this, world_, scenario}.minimize(
      failure.schedule,
      {.seconds_max = seconds,
       .executions_max = start_state() == StartState::restore
                             ? SearchBudget::unlimited
                             : static_cast<std::uint64_t>(seconds.count() * forks_per_second),
       .points_max = static_cast<std::uint64_t>(seconds.count() * points_per_second),
       .numbers_matter = false});
  if (!report.reproduced)
    return;  // its anchors are not unique: the recorded schedule stays, for what it tells
  failure.outcome = report.outcome;
  failure.trace_hash = report.trace_hash;
  failure.at = report.at;
  failure.schedule = report.schedule;
  failure.one_minimal = report.one_minimal;
  std::tie(failure.story, failure.output) = apart<std::pair<std::string, std::string>>([&] {
    Story story{world_, failure.schedule};
    static_cast<void>(replay(scenario, failure.schedule, &story));
    return std::pair{story.text(failure.outcome), world_.output()};
  });
}

ReplayReport Explorer::replay(const Scenario& scenario, const Schedule& schedule, StepListener* listener) {
  const SignalGuard signals;
  world_.set_default_memory(schedule.memory);
  world_.set_default_cpu(schedule.cpu);
  world_.set_findings(schedule.findings);
  world_.set_input(schedule.input);
  if (schedule.start_state == StartState::restore) {
    // What is initialised on first use was so when the schedule was recorded.
    AnchorTracker anchors{world_, nullptr};
    ReplayStrategy strategy{schedule.deviations, world_, anchors};
    execute(scenario, strategy, 0, &anchors);
  }
  AnchorTracker anchors{world_, listener};
  ReplayStrategy strategy{schedule.deviations, world_, anchors};
  const std::uint64_t hash = execute(scenario, strategy, 0, &anchors);
  return ReplayReport{.outcome = world_.scheduler().outcome(),
                      .trace_hash = hash,
                      .at = world_.now(),
                      .divergence = strategy.divergence()};
}

}  // namespace ltsim
