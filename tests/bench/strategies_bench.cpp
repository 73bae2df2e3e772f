// How many executions each strategy needs until it finds what a scenario is known for: mean over seeds.
//
//   strategies_bench [--seeds N] [--executions N] SCENARIO=FINDING ...
//
// A seed that finds nothing within the bound counts as the bound, and the mean is marked with ">".

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/check/signal_guard.hpp"
#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/swarm_strategy.hpp"

namespace {

struct Measured {
  std::uint64_t sum = 0;
  bool missed = false;
};

bool is_found(const ltsim::World& world, std::string_view finding) {
  const ltsim::Outcome& outcome = world.scheduler().outcome();
  return !outcome.passed() &&
         (fmt::format("{}: {}", to_string(outcome.kind), outcome.message).find(finding) != std::string::npos);
}

std::uint64_t executions_until_found(ltsim::World& world, const ltsim::Scenario& scenario,
                                     ltsim::Strategy& strategy, std::uint64_t seed, std::uint64_t most,
                                     std::string_view finding) {
  ltsim::Explorer explorer{world};
  for (std::uint64_t execution = 1; execution <= most; ++execution) {
    explorer.execute(scenario, strategy, ltsim::Explorer::seed_of(seed, execution), nullptr);
    if (is_found(world, finding)) return execution;
    strategy.learn({.points = world.scheduler().points()});
  }
  return most + 1;
}

template <class Strategy>
void measure(ltsim::World& world, const ltsim::Scenario& scenario, std::string_view finding,
             std::uint64_t seeds, std::uint64_t most) {
  Measured measured;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Strategy strategy;
    const std::uint64_t executions = executions_until_found(world, scenario, strategy, seed, most, finding);
    measured.missed = measured.missed || executions > most;
    measured.sum += executions;
  }
  fmt::print(" {:>9}", fmt::format("{}{:.1f}", measured.missed ? ">" : "",
                                   static_cast<double>(measured.sum) / static_cast<double>(seeds)));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t seeds = 20;
  std::uint64_t executions = 20'000;
  ltsim::World world;
  const ltsim::SignalGuard signals;
  fmt::print("{:<40} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "", "swarm", "random", "pct", "pos", "surw",
             "stall");
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--seeds") {
      seeds = std::strtoull(argv[++i], nullptr, 10);
      continue;
    }
    if (argument == "--executions") {
      executions = std::strtoull(argv[++i], nullptr, 10);
      continue;
    }
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const std::string finding = equals == std::string::npos ? "" : argument.substr(equals + 1);
    const ltsim::Scenario* const scenario = ltsim::find_scenario(name);
    if (scenario == nullptr) {
      fmt::print("{}: no such scenario\n", name);
      return 2;
    }
    fmt::print("{:<40}", argument);
    measure<ltsim::SwarmStrategy>(world, *scenario, finding, seeds, executions);
    measure<ltsim::RandomStrategy>(world, *scenario, finding, seeds, executions);
    measure<ltsim::PctStrategy>(world, *scenario, finding, seeds, executions);
    measure<ltsim::PosStrategy>(world, *scenario, finding, seeds, executions);
    measure<ltsim::SurwStrategy>(world, *scenario, finding, seeds, executions);
    measure<ltsim::StallStrategy>(world, *scenario, finding, seeds, executions);
    fmt::print("\n");
  }
  return 0;
}
