#include "sim_clock/scenario/command_line.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "sim_clock/explore/duration_text.hpp"
#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "sim_clock/scenario/report.hpp"
#include "sim_clock/scenario/scenario.hpp"
#include "sim_clock/trace/text_trace.hpp"

namespace ltsim {
namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

constexpr int exit_nothing_found = 0;
constexpr int exit_failure_found = 1;
constexpr int exit_bad_usage = 2;
constexpr int exit_our_fault = 3;

/// Bad usage or an unreadable file: told to the user, exit code 2.
struct UsageError {
  std::string message;
};

struct ExploreArguments {
  std::vector<std::string> scenarios;
  ExploreOptions options;
  double seconds = 0;
  std::string strategy = "random";
  std::string json_file;
  std::string out_folder = "out";
};

struct ReplayArguments {
  std::string file;
  std::string trace;
  std::string out_file;
};

const Scenario& scenario_of_name(const std::string& name) {
  const Scenario* const scenario = find_scenario(name);
  if (scenario == nullptr)
    throw UsageError{fmt::format("there is no scenario \"{}\"; \"ltsim list\" shows those there are", name)};
  return *scenario;
}

/// @return whether the file could be written
[[nodiscard]] bool write_file(const std::filesystem::path& path, const std::string& text) {
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  std::ofstream file{path, std::ios::binary};
  file << text;
  file.close();
  return static_cast<bool>(file);
}

void write_asked_for_file(const std::filesystem::path& path, const std::string& text) {
  if (!write_file(path, text)) throw UsageError{fmt::format("{}: cannot be written", path.string())};
}

std::string read_file(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  if (!file) throw UsageError{fmt::format("{}: cannot be read", path)};
  return {std::istreambuf_iterator<char>{file}, {}};
}

/// "out/paper-time-out.schedule"; the second failure of one exploration gets "-2", and so on.
std::string schedule_path(const std::string& folder, std::string scenario, std::size_t number) {
  std::replace(scenario.begin(), scenario.end(), '/', '-');
  const std::string file = number == 0 ? fmt::format("{}.schedule", scenario)
                                       : fmt::format("{}-{}.schedule", scenario, number + 1);
  return (std::filesystem::path{folder} / file).string();
}

int list() {
  std::size_t width = 0;
  for (const Scenario& scenario : scenarios()) width = std::max(width, scenario.name.size());
  for (const Scenario& scenario : scenarios())
    fmt::print("{:<{}}  {}\n", scenario.name, width, scenario.description);
  return exit_nothing_found;
}

/// Ready to be pasted: in quotes if a shell would read it otherwise.
std::string as_shell_word(const std::string& text) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+:,=@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string{"'\\''"} : std::string{c};
  return quoted + "'";
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

int replay(const ReplayArguments& arguments) {
  const auto schedule = parse_schedule(read_file(arguments.file));
  if (!schedule)
    throw UsageError{
        fmt::format("{}:{}: {}", arguments.file, schedule.error().line, schedule.error().reason)};
  const Scenario& scenario = scenario_of_name(schedule->scenario);
  World world;
  Explorer explorer{world};
  TextTrace trace{world};
  const ReplayReport report =
      explorer.replay(scenario, *schedule, arguments.trace.empty() ? nullptr : &trace);
  if (!arguments.trace.empty() && arguments.out_file.empty()) fmt::print("{}", trace.text());
  if (!arguments.out_file.empty()) write_asked_for_file(arguments.out_file, trace.text());
  if (report.divergence) {
    const Deviation& deviation = *report.divergence->deviation;
    throw UsageError{fmt::format(
        "{}:{}: this line no longer fits: {}\n  {}\nthe execution ended as \"{}{}{}\"", arguments.file,
        deviation.line, report.divergence->reason, to_string(deviation), to_string(report.outcome.kind),
        report.outcome.message.empty() ? "" : ": ", report.outcome.message)};
  }
  fmt::print("{}  {}{}{}\n  at {}, trace hash {:016x}\n", scenario.name, to_string(report.outcome.kind),
             report.outcome.message.empty() ? "" : ": ", report.outcome.message, to_text(report.at),
             report.trace_hash);
  if (report.outcome.kind != schedule->outcome || one_line(report.outcome.message) != schedule->message) {
    fmt::print("  not as recorded: {}{}{}\n", to_string(schedule->outcome),
               schedule->message.empty() ? "" : ": ", schedule->message);
  }
  return report.outcome.passed() ? exit_nothing_found : exit_failure_found;
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  CLI::App app{
      "Runs scenarios in a world where threads, time and semaphores follow a seed.\n"
      "Exit code: 0 nothing found, 1 a failure was found, 2 bad usage or unreadable file, 3 our own fault."};
  app.require_subcommand(1);

  app.add_subcommand("list", "scenarios, a line each");

  ExploreArguments explore_arguments;
  CLI::App* const explore_command = app.add_subcommand("explore", "search scenarios for a failure");
  explore_command->add_option("scenarios", explore_arguments.scenarios, "names as \"list\" shows them")
      ->required();
  explore_command->add_option("--executions", explore_arguments.options.executions_max, "at most so many")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  const CLI::Option* const seconds =
      explore_command->add_option("--seconds", explore_arguments.seconds, "at most so long, in real time")
          ->check(CLI::PositiveNumber);
  explore_command->add_option("--strategy", explore_arguments.strategy, "how choices are made")
      ->capture_default_str()
      ->check(CLI::IsMember({"random"}));
  explore_command->add_option("--seed", explore_arguments.options.seed, "all choices follow from it")
      ->capture_default_str();
  explore_command->add_flag("--keep-going", explore_arguments.options.keep_going,
                            "do not stop at the first failure; report each different one once");
  explore_command->add_option("--json", explore_arguments.json_file,
                              "write a report for programs to this file");
  explore_command->add_option("--out", explore_arguments.out_folder, "folder for schedules")
      ->capture_default_str();

  ReplayArguments replay_arguments;
  CLI::App* const replay_command = app.add_subcommand("replay", "run a schedule again");
  replay_command->add_option("file", replay_arguments.file, "schedule file")->required();
  CLI::Option* const trace =
      replay_command->add_option("--trace", replay_arguments.trace, "show every step: text")
          ->check(CLI::IsMember({"text"}));
  replay_command->add_option("--out", replay_arguments.out_file, "file for the trace, instead of the console")
      ->needs(trace);

  try {
    app.parse(argc, argv);
    if (app.got_subcommand("list")) return list();
    if (app.got_subcommand(replay_command)) return replay(replay_arguments);
    if (!seconds->empty()) {
      explore_arguments.options.seconds_max = std::chrono::duration<double>{explore_arguments.seconds};
      // Whoever gives a time and no number wants the time to decide.
      if (explore_command->count("--executions") == 0) explore_arguments.options.executions_max = unlimited;
    }
    return explore(explore_arguments, argv[0]);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_nothing_found : exit_bad_usage;
  } catch (const UsageError& error) {
    fmt::print(stderr, "ltsim: {}\n", error.message);
    return exit_bad_usage;
  } catch (const Explorer::NotSimulable& error) {
    fmt::print(stderr, "ltsim: {}\n", error.message);
    return exit_our_fault;
  } catch (const std::exception& error) {
    fmt::print(stderr, "ltsim: internal error: {}\n", error.what());
    return exit_our_fault;
  }
}

}  // namespace ltsim
