#include "sim_clock/scenario/scenario.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <string>

#include "sim_clock/scenario/fuzz_target.hpp"

namespace ltsim {
namespace {

std::vector<Scenario>& registry() {
  static std::vector<Scenario> all;
  return all;
}

void add(Scenario scenario) {
  auto& all = registry();
  const auto place = std::lower_bound(all.begin(), all.end(), scenario.name,
                                      [](const Scenario& s, std::string_view n) { return s.name < n; });
  if (place != all.end() && place->name == scenario.name) {
    std::fprintf(stderr, "two scenarios are called %.*s\n", static_cast<int>(scenario.name.size()),
                 scenario.name.data());
    std::exit(2);
  }
  all.insert(place, std::move(scenario));
}

/// One task of one process that reads the input.
void run_target(World& world, const FuzzTarget& target) {
  world.process("target").start("main", [&world, &target] {
    try {
      target.run(std::as_bytes(std::span{world.input()}));
    } catch (const BrokenPromise& broken) {
      world.violated(broken.what());
    }
  });
  world.run();
}

/// The registry with the fuzz targets, which only main() can be sure to find complete.
std::vector<Scenario>& complete_registry() {
  static std::deque<std::string> names;  // a registered name is a view
  if (names.empty()) {
    for (const FuzzTarget& target : fuzz_targets()) {
      if (target.needs_world()) continue;  // registered as what it is
      add({.name = names.emplace_back("fuzz/" + std::string{target.name}),
           .description = target.description,
           .body = [&target](World& world) { run_target(world, target); }});
    }
  }
  return registry();
}

}  // namespace

const std::vector<Scenario>& scenarios() { return complete_registry(); }

const Scenario* find_scenario(std::string_view name) {
  const auto& all = complete_registry();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Scenario& s) { return s.name == name; });
  return found == all.end() ? nullptr : &*found;
}

ScenarioRegistration::ScenarioRegistration(std::string_view name, std::string_view description,
                                           std::function<void(World&)> body) {
  add({.name = name, .description = description, .body = std::move(body)});
}

void add_program_scenario(Scenario scenario) { add(std::move(scenario)); }

}  // namespace ltsim
