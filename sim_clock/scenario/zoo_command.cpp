// ltsim zoo: what each strategy needs to find the known races of this program, how short their schedules get, and
// whether the corrected programs are left alone.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/minimizer.hpp"
#include "sim_clock/explore/strategies.hpp"
#include "sim_clock/scenario/command.hpp"
#include "sim_clock/scenario/shape.hpp"

namespace ltsim {
namespace {

constexpr int name_width = 45;
constexpr int memory_width = 6;
constexpr int number_width = 9;

struct ZooArguments {
  std::vector<std::string> shapes;
  std::uint64_t seeds = 5;
  std::uint64_t executions = 20'000;
};

/// What one strategy needed over all seeds.
struct Needed {
  std::uint64_t sum = 0;
  std::uint64_t most = 0;
  bool missed = false;              ///< some seed found nothing, or something else; it counts with all it had
  std::optional<Schedule> failing;  ///< of the first seed that found it
};

ExploreReport explore(World& world, std::string_view scenario, Memory memory, std::string_view strategy_name,
                      std::uint64_t seed, std::uint64_t executions) {
  ExploreOptions options;
  options.seed = seed;
  options.executions_max = executions;
  options.memory = memory;
  return Explorer{world}.explore(*find_scenario(scenario), *make_strategy(strategy_name), options);
}

Needed measure(World& world, const Shape& shape, std::string_view strategy_name,
               const ZooArguments& arguments) {
  Needed needed;
  for (std::uint64_t seed = 1; seed <= arguments.seeds; ++seed) {
    const ExploreReport report =
        explore(world, shape.name, shape.facts.memory, strategy_name, seed, arguments.executions);
    const bool found = !report.failures.empty() && shape.is_finding(report.failures.front().outcome);
    needed.sum += found ? report.executions : arguments.executions;
    needed.most = std::max(needed.most, report.executions);
    needed.missed = needed.missed || !found;
    if (found && !needed.failing) needed.failing = report.failures.front().schedule;
  }
  return needed;
}

/// Lines of the smallest schedule that the minimizer finds. Counted in executions, so that every machine tells the
/// same.
std::string lines_of_minimal(World& world, const Shape& shape, const std::optional<Schedule>& failing) {
  if (!failing) return "-";
  MinimizeOptions options;
  options.seconds_max = std::chrono::duration<double>::max();
  options.executions_max = 3000;
  const MinimizeReport report = Minimizer{world, *find_scenario(shape.name)}.minimize(*failing, options);
  return report.reproduced ? std::to_string(report.schedule.deviations.size()) : "-";
}

/// Whether the corrected program is never accused, in ten times as many executions as the search needed.
bool corrected_is_silent(World& world, const Shape& shape, std::uint64_t most_needed,
                         const ZooArguments& arguments) {
  const std::uint64_t executions = std::min(10 * most_needed, arguments.executions);
  return explore(world, shape.corrected_name, shape.facts.memory, strategy_names().front(), 1, executions)
      .failures.empty();
}

/// @return whether the default strategy finds the shape from every seed and the corrected program is silent
bool show(World& world, const Shape& shape, const ZooArguments& arguments) {
  fmt::print("{:<{}}{:<{}}", shape.name, name_width, to_string(shape.facts.memory), memory_width);
  std::optional<Needed> by_default;
  for (const std::string& name : strategy_names()) {
    Needed needed = measure(world, shape, name, arguments);
    const double mean = static_cast<double>(needed.sum) / static_cast<double>(arguments.seeds);
    fmt::print("{:>{}}", fmt::format("{}{:.0f}", needed.missed ? ">" : "", mean), number_width);
    std::fflush(stdout);
    if (!by_default) by_default = std::move(needed);
  }
  const std::string lines = lines_of_minimal(world, shape, by_default->failing);
  const bool is_silent = corrected_is_silent(world, shape, by_default->most, arguments);
  fmt::print("{:>7}  {}\n", lines, is_silent ? "silent" : "ACCUSED");
  std::fflush(stdout);
  return !by_default->missed && is_silent;
}

const Shape& shape_of_name(const std::string& name) {
  const Shape* const shape = find_shape(name);
  if (shape == nullptr) {
    throw UsageError{fmt::format(
        "there is no known race \"{}\"; \"ltsim zoo\" without a name shows those there are", name)};
  }
  return *shape;
}

int zoo(const ZooArguments& arguments) {
  std::vector<Shape> chosen;
  for (const std::string& name : arguments.shapes) chosen.push_back(shape_of_name(name));
  if (chosen.empty()) chosen = shapes();
  fmt::print("executions until found, mean of {} seeds; >: not from every seed within {}\n\n{:<{}}{:<{}}",
             arguments.seeds, arguments.executions, "", name_width, "memory", memory_width);
  for (const std::string& name : strategy_names()) fmt::print("{:>{}}", name, number_width);
  fmt::print("{:>7}  corrected\n", "lines");
  World world;
  bool as_expected = true;
  for (const Shape& shape : chosen) as_expected = show(world, shape, arguments) && as_expected;
  return as_expected ? exit_nothing_found : exit_failure_found;
}

}  // namespace

void add_zoo_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<ZooArguments>();
  CLI::App* const command = app.add_subcommand(
      "zoo",
      "known races: what each strategy needs to find them, how many lines their shortest\n"
      "schedules have, and whether the corrected programs are left alone. Exit code 1: the\n"
      "default strategy missed one, or a corrected program was accused");
  command->add_option("--shape", arguments->shapes, "only these, as \"list\" shows them");
  command->add_option("--seeds", arguments->seeds, "searches for each, with the seeds 1, 2 ...")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--executions", arguments->executions, "at most so many for each search")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->callback([arguments, &chosen] {
    chosen = [arguments](std::string_view /*program*/) { return zoo(*arguments); };
  });
}

}  // namespace ltsim
