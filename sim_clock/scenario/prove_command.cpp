// ltsim prove: runs all executions of a scenario within bounds, and says exactly what was covered.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "sim_clock/explore/proof_file.hpp"
#include "sim_clock/explore/prove_in_workers.hpp"
#include "sim_clock/explore/prover.hpp"
#include "sim_clock/explore/worker_pool.hpp"
#include "sim_clock/scenario/command.hpp"
#include "sim_clock/scenario/interrupt.hpp"
#include "sim_clock/scenario/progress_line.hpp"
#include "sim_clock/scenario/report.hpp"

namespace ltsim {
namespace {

struct ProveArguments {
  std::string scenario;
  ProveOptions options;
  double seconds = 0;
  double minimize_seconds = 2;
  std::string checkpoint_file;
  bool begins_anew = false;
  std::string out_folder = "out";
  unsigned jobs = 1;
};

/// 100 is what all of it would be, and more may turn up.
double percent_done(const ProveReport& report) { return std::min(99.9, std::floor(1000 * report.done) / 10); }

std::string progress_text(const ProveReport& report) {
  const double left = report.done > 0 ? report.seconds * (1 - report.done) / report.done : 0;
  return fmt::format("{} executions, {:.0f} s, {:.1f} % of what is known of, {:.0f} s left for that",
                     report.counts.executions, report.seconds, percent_done(report), left);
}

/// @param text  a number, or "any"
std::optional<unsigned> to_silences(const std::string& text) {
  if (text == "any") return std::nullopt;
  unsigned number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size())
    throw CLI::ValidationError{"--silences", fmt::format("\"{}\" is no whole number, nor \"any\"", text)};
  return number;
}

/// What an earlier run has left, if it was of the same search.
/// @throw UsageError if the file is of another one, or cannot be read
ProveReport earlier_part(const ProveArguments& arguments, const std::string& path) {
  if (arguments.begins_anew || !std::filesystem::exists(path)) return {};
  std::ifstream file{path, std::ios::binary};
  const std::string text{std::istreambuf_iterator<char>{file}, {}};
  const auto found = parse_proof(text, arguments.scenario, arguments.options);
  if (!file || !found)
    throw UsageError{fmt::format("{}: {}; \"--anew\" begins from the beginning", path,
                                 found ? std::string{"cannot be read"} : found.error())};
  fmt::print("  goes on from {}, after {} executions\n", path, found->counts.executions);
  return *found;
}

ProveReport run_proof(const Scenario& scenario, const ProveArguments& arguments, const ProveReport& earlier) {
  ProgressLine line{scenario.name};
  const auto on_progress = [&](const ProveReport& so_far) {
    line.show(std::chrono::duration<double>{so_far.seconds}, [&] { return progress_text(so_far); });
    return InterruptGuard::signal() == 0;
  };
  if (arguments.jobs != 1)
    return prove_in_workers(scenario, arguments.options, {.jobs = arguments.jobs}, earlier, on_progress);
  World world;
  return Prover{world}.prove(scenario, arguments.options, earlier, on_progress);
}

int tell_failure(const ProveArguments& arguments, std::string_view program, const ProveReport& report) {
  const Failure& failure = *report.failure;
  const std::string path = file_of_scenario(arguments.out_folder, arguments.scenario, ".schedule");
  fmt::print("{}", describe(failure, "exhaustive"));
  const FileResult written = write_file(path, to_string(failure.schedule));
  if (written) {
    fmt::print("  replay:  {} replay {}\n", as_shell_word(std::string{program}), as_shell_word(path));
  } else {
    fmt::print("  {}: cannot be written: {}; the lines above are what it would hold\n", path,
               written.error());
  }
  return exit_failure_found;
}

int prove(const ProveArguments& arguments, std::string_view program) {
  const ProofBounds& bounds = arguments.options.bounds;
  if (bounds.silences != 0U && !bounds.preemptions && !bounds.states)
    throw UsageError{
        "--silences needs --preemptions or --states: where time may pass at any moment, the orders that make "
        "no "
        "difference are not known"};
  if (!bounds.silences && !bounds.states)
    throw UsageError{"--silences any needs --states: otherwise only a bounded search ends"};
  if (bounds.states && arguments.jobs != 1)
    throw UsageError{
        "--jobs cannot be with --states: which states were seen before depends on the order of the search"};
  const Scenario& scenario = scenario_of_name(arguments.scenario);
  const std::string checkpoint_path =
      arguments.checkpoint_file.empty() ? file_of_scenario(arguments.out_folder, arguments.scenario, ".proof")
                                        : arguments.checkpoint_file;
  fmt::print("{}  {}{}\n", scenario.name, describe_bounds(arguments.options),
             arguments.jobs == 1 ? "" : fmt::format(", {} jobs", arguments.jobs));
  const ProveReport earlier = earlier_part(arguments, checkpoint_path);
  std::fflush(stdout);  // before the first step: a hang or a crash must not lose it
  const InterruptGuard interrupt;
  const ProveReport report = run_proof(scenario, arguments, earlier);
  if (report.error) {
    if (!report.checkpoint.empty()) {
      write_asked_for_file(checkpoint_path, to_proof(report, arguments.scenario, arguments.options));
      fmt::print("  the same command goes on from {}\n", checkpoint_path);
    }
    fmt::print(stderr, "ltsim: {}\n", *report.error);
    if (!report.failure) return exit_our_fault;
  }
  fmt::print("{}  {}\n  {} scheduling points, {} executions left when they came to nothing new, {:.1f} s\n",
             scenario.name, describe_coverage(report, arguments.options), report.counts.points,
             report.counts.redundant, report.seconds);
  if (report.failure) return tell_failure(arguments, program, report);
  if (report.complete) {
    std::error_code nothing_to_remove;
    std::filesystem::remove(checkpoint_path, nothing_to_remove);
    return exit_nothing_found;
  }
  write_asked_for_file(checkpoint_path, to_proof(report, arguments.scenario, arguments.options));
  fmt::print("  no proof yet: about {:.1f} % of what is known of is done; the same command goes on from {}\n",
             percent_done(report), checkpoint_path);
  return InterruptGuard::signal() == 0 ? exit_nothing_found : exit_of_signal(InterruptGuard::signal());
}

}  // namespace

void add_prove_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<ProveArguments>();
  CLI::App* const command =
      app.add_subcommand("prove", "run all executions of a scenario within bounds, and say what was covered");
  command->add_option("scenario", arguments->scenario, "name as \"list\" shows it")->required();
  command->add_option("--preemptions", arguments->options.bounds.preemptions,
                      "at most so many switches from a task that could go on; any number unless given, and "
                      "then only one of the "
                      "orders that make no difference is run");
  command
      ->add_option_function<std::string>(
          "--silences",
          [arguments](const std::string& text) { arguments->options.bounds.silences = to_silences(text); },
          "with --preemptions or --states: so often time may go on, from timer to timer, while some task "
          "that "
          "could run takes no step; \"any\" with --states: any number")
      ->default_str("0");
  command->add_flag(
      "--states", arguments->options.bounds.states,
      "tell states apart by the whole memory, and go on from each of them once, instead of leaving "
      "out orders that make no difference: for few states and many ways to them; memory sc only");
  command
      ->add_option(
          "--looks", arguments->options.bounds.looks,
          "a task that polls looks so often in vain before it waits for somebody to change something")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  add_memory_option(*command, arguments->options.memory);
  add_findings_options(*command, arguments->options.findings);
  const CLI::Option* const seconds =
      command
          ->add_option("--seconds", arguments->seconds,
                       "at most so long, in real time; the rest can follow later")
          ->check(CLI::PositiveNumber);
  command
      ->add_option("--minimize-seconds", arguments->minimize_seconds,
                   "real time for making the schedule of a failure small; 0: as it was found")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--jobs", arguments->jobs,
                   "worker processes; the result does not depend on it; not with --states")
      ->capture_default_str()
      ->check(CLI::Range(1U, WorkerPoolOptions::jobs_max));
  command->add_option(
      "--checkpoint", arguments->checkpoint_file,
      "file for where the search stands when it is interrupted; SCENARIO.proof in the folder of schedules if "
      "not given");
  command->add_flag("--anew", arguments->begins_anew, "do not go on from a checkpoint");
  command->add_option("--out", arguments->out_folder, "folder for schedules")->capture_default_str();
  command->callback([=, &chosen] {
    arguments->options.minimize_seconds = std::chrono::duration<double>{arguments->minimize_seconds};
    if (!seconds->empty()) arguments->options.seconds_max = std::chrono::duration<double>{arguments->seconds};
    chosen = [arguments](std::string_view program) { return prove(*arguments, program); };
  });
}

}  // namespace ltsim
