#include "sim_clock/scenario/fuzz_scenario.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "sim_clock/check/signal_guard.hpp"
#include "sim_clock/explore/bytes_strategy.hpp"
#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/minimizer.hpp"
#include "sim_clock/explore/record_mutator.hpp"

namespace ltsim {
namespace {

/// The engine's own answers to being stopped: what they call must not be the simulated calls of a task that runs just then.
class StopSignals {
 public:
  StopSignals() {
    for (std::size_t i = 0; i < signals.size(); ++i) {
      sigaction(signals[i], nullptr, &engines_[i]);
      if ((engines_[i].sa_flags & SA_SIGINFO) == 0) continue;  // nobody has one
      struct sigaction action = engines_[i];
      action.sa_sigaction = &pass_on;
      sigaction(signals[i], &action, nullptr);
    }
  }

 private:
  static constexpr std::array signals{SIGINT, SIGTERM, SIGXCPU};

  static void pass_on(int signal, siginfo_t* details, void* context) {
    const GhostScope ghost;
    const auto index = std::ranges::find(signals, signal) - signals.begin();
    engines_[static_cast<std::size_t>(index)].sa_sigaction(signal, details, context);
  }

  inline static std::array<struct sigaction, signals.size()> engines_{};
};

/// The one world of a fuzz program, and what it runs.
struct Fuzzing {
  World world;
  Explorer explorer{world};
  BytesStrategy strategy;
  const Scenario* steered = nullptr;  // in place of the target's own
  /// Kept from execution to execution: to set the handlers costs as much as a short execution. Given up before a failure is
  /// told: the engine's own handlers keep the input then.
  std::optional<SignalGuard> signals;
};

Fuzzing& fuzzing() {
  static Fuzzing only;
  return only;
}

std::string as_text(const Outcome& outcome) {
  return fmt::format("{}: {}", to_string(outcome.kind), outcome.message);
}

bool steer(std::string_view scenario) {
  fuzzing().steered = find_scenario(scenario);
  return fuzzing().steered != nullptr;
}

Schedule record(const FuzzTarget& target, std::span<const std::byte> input) {
  constexpr std::chrono::seconds time_to_make_it_small{10};
  Fuzzing& it = fuzzing();
  const Scenario& scenario =
      it.steered != nullptr ? *it.steered : *find_scenario("fuzz/" + std::string{target.name});
  it.strategy.set_bytes(input);
  Schedule schedule;
  {
    const SignalGuard signals;
    // What is initialised on first use is so in all executions but the first.
    it.explorer.execute(scenario, it.strategy, 0, nullptr);
    schedule = it.explorer.record(scenario, it.strategy, 0).schedule;
  }
  if (schedule.outcome == OutcomeKind::passed) return schedule;
  return Minimizer{it.world, scenario}.minimize(schedule, {.seconds_max = time_to_make_it_small}).schedule;
}

std::string replay(const Schedule& schedule) {
  Fuzzing& it = fuzzing();
  const Scenario* const scenario = find_scenario(schedule.scenario);
  if (scenario == nullptr) throw BrokenPromise{fmt::format("there is no scenario {}", schedule.scenario)};
  it.signals.reset();
  const ReplayReport report = it.explorer.replay(*scenario, schedule, nullptr);
  if (!report.outcome.passed()) throw BrokenPromise{as_text(report.outcome)};
  if (!report.divergence) return {};
  return fmt::format("{}: {}", to_string(*report.divergence->deviation), report.divergence->reason);
}

std::size_t mutate(std::span<std::byte> data, std::size_t size, unsigned seed, PlainMutator /*plain*/) {
  return RecordMutator{fuzzing().strategy.most_decisions(), seed}.mutate(data, size);
}

std::size_t splice(std::span<const std::byte> one, std::span<const std::byte> other,
                   std::span<std::byte> into, unsigned seed) {
  return RecordMutator{fuzzing().strategy.most_decisions(), seed}.splice(one, other, into);
}

}  // namespace

void mark_fuzzed_states_in(std::span<std::uint8_t> marks) { fuzzing().world.coverage().mark_in(marks); }

void run_fuzz_scenario(const Scenario& own, std::span<const std::byte> bytes) {
  Fuzzing& it = fuzzing();
  static const StopSignals stop_signals;
  if (!it.signals) it.signals.emplace();
  it.strategy.set_bytes(bytes);
  std::string failure;
  try {
    it.explorer.execute(it.steered != nullptr ? *it.steered : own, it.strategy, 0, nullptr);
    if (!it.world.failed()) return;
    failure = as_text(it.world.scheduler().outcome());
  } catch (const Explorer::NotSimulable& error) {
    failure = error.message;
  }
  it.signals.reset();
  throw BrokenPromise{failure};
}

FuzzScenarioRegistration::FuzzScenarioRegistration(std::string_view name, std::string_view scenario_name,
                                                   std::string_view description, void (*body)(World&),
                                                   void (*run)(std::span<const std::byte> input)) {
  const ScenarioRegistration scenario{scenario_name, description, body};
  const FuzzTargetRegistration target{name,
                                      {.split = &BytesStrategy::split, .mutate = &mutate, .splice = &splice},
                                      description,
                                      run,
                                      {.steer = &steer, .record = &record, .replay = &replay}};
}

}  // namespace ltsim
