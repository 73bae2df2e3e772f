#include "sim_clock/scenario/scenario.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace ltsim {
namespace {

std::vector<Scenario>& registry() {
  static std::vector<Scenario> all;
  return all;
}

}  // namespace

const std::vector<Scenario>& scenarios() { return registry(); }

const Scenario* find_scenario(std::string_view name) {
  const auto found =
      std::find_if(registry().begin(), registry().end(), [&](const Scenario& s) { return s.name == name; });
  return found == registry().end() ? nullptr : &*found;
}

ScenarioRegistration::ScenarioRegistration(std::string_view name, std::string_view description,
                                           void (*body)(World&)) {
  auto& all = registry();
  const auto place = std::lower_bound(all.begin(), all.end(), name,
                                      [](const Scenario& s, std::string_view n) { return s.name < n; });
  if (place != all.end() && place->name == name) {
    std::fprintf(stderr, "two scenarios are called %.*s\n", static_cast<int>(name.size()), name.data());
    std::exit(2);
  }
  all.insert(place, Scenario{.name = name, .description = description, .body = body});
}

}  // namespace ltsim
