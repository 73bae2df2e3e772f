// ltsim explore: searches scenarios for a failure, tells each one and writes its schedule down.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "sim_clock/scenario/command.hpp"
#include "sim_clock/scenario/report.hpp"

namespace ltsim {
namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

struct ExploreArguments {
  std::vector<std::string> scenarios;
  ExploreOptions options;
  double seconds = 0;
  double minimize_seconds = 2;
  std::string strategy = "random";
  std::string json_file;
  std::string out_folder = "out";
};

/// "out/paper-time-out.schedule"; the second failure of one exploration gets "-2", and so on.
std::string schedule_path(const std::string& folder, std::string scenario, std::size_t number) {
  std::replace(scenario.begin(), scenario.end(), '/', '-');
  const std::string file = number == 0 ? fmt::format("{}.schedule", scenario)
                                       : fmt::format("{}-{}.schedule", scenario, number + 1);
  return (std::filesystem::path{folder} / file).string();
}

/// "1000 executions and 2 s"
std::string describe_limits(const ExploreArguments& arguments) {
  const bool counted = arguments.options.executions_max != unlimited;
  const std::string executions =
      counted ? fmt::format("{} executions", arguments.options.executions_max) : "";
  if (!arguments.options.seconds_max) return executions;
  return fmt::format("{}{}{} s", executions, counted ? " and " : "", arguments.seconds);
}

int explore(const ExploreArguments& arguments, std::string_view program) {
  if (!arguments.json_file.empty() && arguments.scenarios.size() != 1) {
    throw UsageError{"--json writes the report of one scenario; name one"};
  }
  std::vector<const Scenario*> chosen;
  for (const std::string& name : arguments.scenarios) chosen.push_back(&scenario_of_name(name));
  World world;
  Explorer explorer{world};
  RandomStrategy strategy;
  bool found = false;
  for (const Scenario* const scenario : chosen) {
    fmt::print("{}  seed {}, strategy {}, at most {}\n", scenario->name, arguments.options.seed,
               strategy.name(), describe_limits(arguments));
    std::fflush(stdout);  // before the first step: a hang or a crash must not lose it
    const ExploreReport report = explorer.explore(*scenario, strategy, arguments.options);
    std::vector<std::string> paths;
    for (const Failure& failure : report.failures) {
      paths.push_back(schedule_path(arguments.out_folder, std::string{scenario->name}, paths.size()));
      fmt::print("{}", describe(failure, strategy.name()));
      // The failure counts, and has been told, also where its file cannot be written.
      if (write_file(paths.back(), to_string(failure.schedule))) {
        fmt::print("  replay:  {} replay {}\n", as_shell_word(std::string{program}),
                   as_shell_word(paths.back()));
      } else {
        fmt::print("  {}: cannot be written; the lines above are what it would hold\n", paths.back());
      }
    }
    found = found || !report.failures.empty();
    if (report.failures.empty()) {
      fmt::print("{}  nothing found: {} executions, {} different traces, {} scheduling points, {:.1f} s\n",
                 scenario->name, report.executions, report.distinct_schedules, report.points, report.seconds);
    }
    if (!arguments.json_file.empty()) {
      write_asked_for_file(arguments.json_file, to_json({.scenario = scenario->name,
                                                         .strategy = strategy.name(),
                                                         .seed = arguments.options.seed,
                                                         .report = report,
                                                         .schedule_paths = paths}));
    }
  }
  return found ? exit_failure_found : exit_nothing_found;
}

}  // namespace

void add_explore_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<ExploreArguments>();
  CLI::App* const command = app.add_subcommand("explore", "search scenarios for a failure");
  command->add_option("scenarios", arguments->scenarios, "names as \"list\" shows them")->required();
  const CLI::Option* const executions =
      command->add_option("--executions", arguments->options.executions_max, "at most so many")
          ->capture_default_str()
          ->check(CLI::PositiveNumber);
  const CLI::Option* const seconds =
      command->add_option("--seconds", arguments->seconds, "at most so long, in real time")
          ->check(CLI::PositiveNumber);
  command->add_option("--strategy", arguments->strategy, "how choices are made")
      ->capture_default_str()
      ->check(CLI::IsMember({"random"}));
  command->add_option("--seed", arguments->options.seed, "all choices follow from it")->capture_default_str();
  command->add_flag("--keep-going", arguments->options.keep_going,
                    "do not stop at the first failure; report each different one once");
  command
      ->add_option("--minimize-seconds", arguments->minimize_seconds,
                   "real time for making the schedule of each failure small; 0: as it was found")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--json", arguments->json_file, "write a report for programs to this file");
  command->add_option("--out", arguments->out_folder, "folder for schedules")->capture_default_str();
  command->callback([=, &chosen] {
    arguments->options.minimize_seconds = std::chrono::duration<double>{arguments->minimize_seconds};
    if (!seconds->empty()) {
      arguments->options.seconds_max = std::chrono::duration<double>{arguments->seconds};
      // Whoever gives a time and no number wants the time to decide.
      if (executions->empty()) arguments->options.executions_max = unlimited;
    }
    chosen = [arguments](std::string_view program) { return explore(*arguments, program); };
  });
}

}  // namespace ltsim
