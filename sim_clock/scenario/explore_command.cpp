// ltsim explore: searches scenarios for a failure, tells each one and writes its schedule down.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/explore/strategies.hpp"
#include "sim_clock/explore/worker_pool.hpp"
#include "sim_clock/scenario/command.hpp"
#include "sim_clock/scenario/interrupt.hpp"
#include "sim_clock/scenario/progress_line.hpp"
#include "sim_clock/scenario/report.hpp"

namespace ltsim {
namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

struct ExploreArguments {
  std::vector<std::string> scenarios;
  ExploreOptions options;
  double seconds = 0;
  double minimize_seconds = 2;
  unsigned jobs = 1;
  double hang_seconds = 10;
  std::string strategy = strategy_names().front();
  std::string json_file;
  std::string junit_file;
  std::string out_folder = "out";
};

/// "out/paper-time-out.schedule"; the second failure of one exploration gets "-2", and so on.
std::string schedule_path(const std::string& folder, std::string_view scenario, std::size_t number) {
  return file_of_scenario(folder, scenario,
                          number == 0 ? ".schedule" : fmt::format("-{}.schedule", number + 1));
}

/// "at most 1000 executions and 2 s"
std::string describe_limits(const ExploreArguments& arguments) {
  const bool counted = arguments.options.executions_max != unlimited;
  const std::string executions =
      counted ? fmt::format("{} executions", arguments.options.executions_max) : "";
  if (!arguments.options.seconds_max) return "at most " + executions;
  return fmt::format("at most {}{}{} s", executions, counted ? " and " : "", arguments.seconds);
}

/// A scenario brings its own state, a whole program has one that something must put back.
std::string_view describe_start_state(const Scenario& scenario, StartState state) {
  if (state == StartState::fork) return ", each execution in a process of its own";
  return scenario.program.empty() ? "" : ", memory put back before each execution";
}

/// "  replay:  ltsim replay FILE", or how else the failure is seen again.
void tell_how_to_see_again(const ExploreArguments& arguments, std::string_view program,
                           const Failure& failure, const std::string& path, const FileResult& written) {
  const std::string call = as_shell_word(std::string{program});
  if (!failure.has_schedule) {
    const Scenario& scenario = scenario_of_name(failure.schedule.scenario);
    std::string what = as_shell_word(failure.schedule.scenario);
    if (!scenario.program.empty()) what = "--";
    for (const std::string& word : scenario.program) what += " " + as_shell_word(word);
    // All up to there: what the strategy has learned by then belongs to it.
    fmt::print("  again:  {} explore --strategy {} --seed {} --jobs {} --executions {}{}{}{}{}{}{} {}\n",
               call, arguments.strategy, arguments.options.seed, arguments.jobs, failure.execution,
               arguments.options.memory == Memory::sc ? "" : " --memory c11",
               arguments.options.cpu == Cpu::many ? "" : " --cpu one-fifo",
               arguments.options.findings.races ? "" : " --races off",
               arguments.options.findings.leaks ? "" : " --leaks off",
               arguments.options.start_state == StartState::restore ? "" : " --state fork",
               arguments.options.keep_going ? " --keep-going" : "", what);
  } else if (written) {
    fmt::print("  replay:  {} replay {}\n", call, as_shell_word(path));
  } else {
    // The failure counts, and has been told, also where its file cannot be written.
    fmt::print("  {}: cannot be written: {}; the lines above are what it would hold\n", path,
               written.error());
  }
}

/// @param shown  when the line was shown last
std::string progress_text(const ExploreProgress& progress, const ExploreProgress& shown) {
  const double executions = static_cast<double>(progress.executions - shown.executions);
  return fmt::format("{} executions, {:.0f} per second, {} failures", progress.executions,
                     executions / (progress.elapsed - shown.elapsed).count(), progress.failures);
}

/// What the program has written in the failing execution.
void tell_output(const std::string& path, const std::string& output) {
  const FileResult written = write_file(path, output);
  if (written) {
    fmt::print("  output:  {}\n", path);
  } else {
    fmt::print("  {}: cannot be written: {}\n", path, written.error());
  }
}

/// Tells each failure and writes its schedule.
void tell_failures(const ExploreArguments& arguments, std::string_view program, ScenarioReport& report) {
  for (const Failure& failure : report.explored.failures) {
    const std::string path =
        schedule_path(arguments.out_folder, report.scenario, report.schedule_paths.size());
    fmt::print("{}", describe(failure, report.strategy));
    const FileResult written =
        failure.has_schedule ? write_file(path, to_string(failure.schedule)) : FileResult{};
    tell_how_to_see_again(arguments, program, failure, path, written);
    report.schedule_paths.push_back(failure.has_schedule && written ? path : "");
    if (!failure.output.empty())
      tell_output(std::filesystem::path{path}.replace_extension(".output").string(), failure.output);
  }
}

ScenarioReport explore_one_scenario(const Scenario& scenario, const ExploreArguments& arguments,
                                    std::string_view program) {
  fmt::print("{}  seed {}, strategy {}, {}{}{}\n", scenario.name, arguments.options.seed, arguments.strategy,
             describe_limits(arguments), arguments.jobs == 1 ? "" : fmt::format(", {} jobs", arguments.jobs),
             describe_start_state(scenario, arguments.options.start_state));
  std::fflush(stdout);  // before the first step: a hang or a crash must not lose it
  WorkerPoolReport pool_report;
  {
    ProgressLine line{scenario.name};
    ExploreProgress shown;
    pool_report = explore_in_workers(
        scenario, [&] { return make_strategy(arguments.strategy); }, arguments.options,
        {.jobs = arguments.jobs,
         .hang_after = std::chrono::duration<double>{arguments.hang_seconds},
         .on_progress = [&](const ExploreProgress& progress) {
           line.show(progress.elapsed,
                     [&] { return progress_text(progress, std::exchange(shown, progress)); });
           return InterruptGuard::signal() == 0;
         }});
  }
  ScenarioReport report{.scenario = scenario.name,
                        .strategy = arguments.strategy,
                        .seed = arguments.options.seed,
                        .explored = std::move(pool_report.explored),
                        .schedule_paths = {},
                        .error = std::move(pool_report.error)};
  tell_failures(arguments, program, report);
  if (report.explored.failures.empty() && !report.error) {
    fmt::print("{}  nothing found{}: {} executions, {} different traces, {} scheduling points, {:.1f} s\n",
               scenario.name, pool_report.stopped ? " before the interruption" : "",
               report.explored.executions, report.explored.distinct_schedules, report.explored.points,
               report.explored.seconds);
  }
  for (const std::uint64_t execution : pool_report.abandoned) {
    fmt::print("  execution {}, seed {:#x}, did not end and was killed\n", execution,
               Explorer::seed_of(arguments.options.seed, execution));
  }
  if (report.error) fmt::print(stderr, "ltsim: {}\n", *report.error);
  return report;
}

/// @return whether it was asked for and could not be written
bool fails_to_write(const std::string& path, const std::string& text) {
  if (path.empty()) return false;
  const FileResult written = write_file(path, text);
  if (!written) fmt::print(stderr, "ltsim: {}: cannot be written: {}\n", path, written.error());
  return !written;
}

int explore(const ExploreArguments& arguments, std::string_view program) {
  std::vector<const Scenario*> chosen;
  for (const std::string& name : arguments.scenarios) chosen.push_back(&scenario_of_name(name));
  const InterruptGuard interrupt;
  std::vector<ScenarioReport> reports;
  for (const Scenario* const scenario : chosen) {
    reports.push_back(explore_one_scenario(*scenario, arguments, program));
    if (reports.back().error || InterruptGuard::signal() != 0) break;
  }
  const bool has_error = reports.back().error.has_value();
  const bool found = std::any_of(reports.begin(), reports.end(), [](const ScenarioReport& report) {
    return !report.explored.failures.empty();
  });
  const bool json_fails = fails_to_write(arguments.json_file, to_json(reports));
  const bool junit_fails = fails_to_write(arguments.junit_file, to_junit(reports));
  if (has_error) return exit_our_fault;
  if (found) return exit_failure_found;
  if (json_fails || junit_fails) return exit_bad_usage;
  return InterruptGuard::signal() == 0 ? exit_nothing_found : exit_of_signal(InterruptGuard::signal());
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
      ->check(CLI::IsMember(strategy_names()));
  command->add_option("--seed", arguments->options.seed, "all choices follow from it")->capture_default_str();
  command
      ->add_option_function<std::string>(
          "--cpu",
          [arguments](const std::string& cpu) {
            arguments->options.cpu = cpu == to_string(Cpu::many) ? Cpu::many : Cpu::one_fifo;
          },
          "processors of the machine, unless the scenario says otherwise; one-fifo: one that honours "
          "SCHED_FIFO priorities")
      ->check(CLI::IsMember({std::string{to_string(Cpu::many)}, std::string{to_string(Cpu::one_fifo)}}));
  add_memory_option(*command, arguments->options.memory);
  add_findings_options(*command, arguments->options.findings);
  command
      ->add_option_function<std::string>(
          "--state",
          [arguments](const std::string& state) {
            arguments->options.start_state =
                state == to_string(StartState::fork) ? StartState::fork : StartState::restore;
          },
          "how each execution comes to begin with the same state. restore: a whole program's variables, heap "
          "and "
          "thread-locals are put back, not what libraries keep for themselves; fork: in a process of its "
          "own, some "
          "thirty times slower")
      ->check(CLI::IsMember(
          {std::string{to_string(StartState::restore)}, std::string{to_string(StartState::fork)}}));
  command->add_flag("--keep-going", arguments->options.keep_going,
                    "do not stop at the first failure; report each different one once");
  command
      ->add_option("--minimize-seconds", arguments->minimize_seconds,
                   "real time for making the schedule of each failure small; 0: as it was found")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--jobs", arguments->jobs, "worker processes")
      ->capture_default_str()
      ->check(CLI::Range(1U, WorkerPoolOptions::jobs_max));
  command
      ->add_option("--hang-seconds", arguments->hang_seconds,
                   "without a scheduling point for so long, in real time, an execution hangs")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--json", arguments->json_file,
                      "write a report for programs to this file: one object, of several scenarios an array");
  command->add_option("--junit", arguments->junit_file, "write a report in JUnit's format to this file");
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
