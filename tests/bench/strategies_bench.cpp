// How many executions each strategy needs until it finds a known race: the mean over seeds, for each shape of
// the zoo, and the geometric mean over all shapes.
//
//   strategies_bench [--seeds N] [--executions N] [SHAPE ...]
//
// A seed that finds nothing within the bound counts as the bound, and the mean is marked with ">". The last
// column relates the default strategy to the best other one.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/check/signal_guard.hpp"
#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/swarm_strategy.hpp"
#include "sim_clock/scenario/shape.hpp"

namespace {

using MakeStrategy = std::unique_ptr<ltsim::Strategy> (*)();

template <class Kind>
std::unique_ptr<ltsim::Strategy> make() {
  return std::make_unique<Kind>();
}

// The default first.
constexpr std::array<MakeStrategy, 6> strategies{&make<ltsim::SwarmStrategy>, &make<ltsim::RandomStrategy>,
                                                 &make<ltsim::PctStrategy>,   &make<ltsim::PosStrategy>,
                                                 &make<ltsim::SurwStrategy>,  &make<ltsim::StallStrategy>};

struct Bounds {
  std::uint64_t seeds = 20;
  std::uint64_t executions = 20'000;
};

struct Measured {
  double mean = 0;
  bool missed = false;
};

std::uint64_t executions_until_found(ltsim::World& world, const ltsim::Shape& shape,
                                     ltsim::Strategy& strategy, std::uint64_t seed, std::uint64_t most) {
  const ltsim::Scenario& scenario = *ltsim::find_scenario(shape.name);
  ltsim::Explorer explorer{world};
  world.set_default_memory(shape.facts.memory);
  world.coverage().forget();
  for (std::uint64_t execution = 1; execution <= most; ++execution) {
    explorer.execute(scenario, strategy, ltsim::Explorer::seed_of(seed, execution), nullptr);
    if (shape.is_finding(world.scheduler().outcome())) return execution;
    strategy.learn({.points = world.scheduler().points(), .new_states = world.coverage().new_in_execution()});
  }
  return most + 1;
}

Measured measure(ltsim::World& world, const ltsim::Shape& shape, MakeStrategy make_strategy,
                 const Bounds& bounds) {
  Measured measured;
  for (std::uint64_t seed = 1; seed <= bounds.seeds; ++seed) {
    const auto strategy = make_strategy();
    const std::uint64_t executions = executions_until_found(world, shape, *strategy, seed, bounds.executions);
    measured.missed = measured.missed || executions > bounds.executions;
    measured.mean += static_cast<double>(executions) / static_cast<double>(bounds.seeds);
  }
  return measured;
}

}  // namespace

int main(int argc, char** argv) {
  Bounds bounds;
  std::vector<const ltsim::Shape*> chosen;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if ((argument == "--seeds" || argument == "--executions") && i + 1 < argc) {
      (argument == "--seeds" ? bounds.seeds : bounds.executions) = std::strtoull(argv[++i], nullptr, 10);
    } else if (const ltsim::Shape* const shape = ltsim::find_shape(argument); shape != nullptr) {
      chosen.push_back(shape);
    } else {
      fmt::print(stderr, "strategies_bench: there is no shape \"{}\"\n", argument);
      return 2;
    }
  }
  if (chosen.empty()) {
    for (const ltsim::Shape& shape : ltsim::shapes()) chosen.push_back(&shape);
  }

  ltsim::World world;
  const ltsim::SignalGuard signals;
  fmt::print("{:<44}", "");
  for (const MakeStrategy make_strategy : strategies) fmt::print(" {:>9}", make_strategy()->name());
  fmt::print(" {:>9}\n", "/best");
  std::array<double, strategies.size()> logarithms{};
  double worst_ratio = 0;
  for (const ltsim::Shape* const shape : chosen) {
    fmt::print("{:<44}", shape->name);
    double best = INFINITY;
    double of_default = 0;
    for (std::size_t i = 0; i < strategies.size(); ++i) {
      const Measured measured = measure(world, *shape, strategies[i], bounds);
      fmt::print(" {:>9}", fmt::format("{}{:.1f}", measured.missed ? ">" : "", measured.mean));
      std::fflush(stdout);
      logarithms[i] += std::log(measured.mean) / static_cast<double>(chosen.size());
      if (i == 0) of_default = measured.mean;
      if (i != 0) best = std::min(best, measured.mean);
    }
    worst_ratio = std::max(worst_ratio, of_default / best);
    fmt::print(" {:>9.2f}\n", of_default / best);
  }
  fmt::print("{:<44}", "geometric mean");
  for (const double logarithm : logarithms) fmt::print(" {:>9.2f}", std::exp(logarithm));
  fmt::print(" {:>9.2f} at most\n", worst_ratio);
  return 0;
}
