// ltsim list: the scenarios of this program.

#include <algorithm>

#include <fmt/format.h>

#include "sim_clock/scenario/command.hpp"

namespace ltsim {
namespace {

int list() {
  std::size_t width = 0;
  for (const Scenario& scenario : scenarios()) width = std::max(width, scenario.name.size());
  for (const Scenario& scenario : scenarios())
    fmt::print("{:<{}}  {}\n", scenario.name, width, scenario.description);
  return exit_nothing_found;
}

}  // namespace

void add_list_command(CLI::App& app, Command& chosen) {
  app.add_subcommand("list", "scenarios, a line each")->callback([&chosen] {
    chosen = [](std::string_view /*program*/) { return list(); };
  });
}

}  // namespace ltsim
