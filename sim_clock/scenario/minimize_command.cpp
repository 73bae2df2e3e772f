// ltsim minimize: makes a schedule that fails as small as it goes.

#include <memory>
#include <string>

#include <fmt/format.h>

#include "sim_clock/explore/minimizer.hpp"
#include "sim_clock/scenario/command.hpp"

namespace ltsim {
namespace {

struct MinimizeArguments {
  std::string file;
  std::string out_file;
  double seconds = 10;
};

std::size_t lines_count(const Schedule& schedule) {
  return schedule.input.size() + schedule.deviations.size();
}

int minimize(const MinimizeArguments& arguments, std::string_view program) {
  const Schedule schedule = read_schedule(arguments.file);
  const Scenario& scenario = scenario_of(schedule);
  World world;
  Explorer explorer{world};
  explorer.set_start_state(schedule.start_state);
  const MinimizeReport report = Minimizer{explorer, world, scenario}.minimize(
      schedule, {.seconds_max = std::chrono::duration<double>{arguments.seconds}});
  if (!report.reproduced) {
    throw UsageError{fmt::format(
        "{}: does not fail as it says, so there is nothing to make smaller; \"replay\" shows how it ends",
        arguments.file)};
  }
  const std::string& file = arguments.out_file.empty() ? arguments.file : arguments.out_file;
  write_asked_for_file(file, to_string(report.schedule));
  fmt::print(
      "{}  {}{}{}\n  {} lines, minimized to {} in {} executions{}\n", scenario.name,
      to_string(report.outcome.kind), report.outcome.message.empty() ? "" : ": ", report.outcome.message,
      lines_count(schedule), lines_count(report.schedule), report.executions,
      report.one_minimal ? "; without any one of them the failure is gone" : "; more time may leave fewer");
  for (const std::string& line : input_lines(report.schedule)) fmt::print("    {}\n", line);
  for (const Deviation& deviation : report.schedule.deviations) fmt::print("    {}\n", to_string(deviation));
  fmt::print("  replay:  {} replay {}\n", as_shell_word(std::string{program}), as_shell_word(file));
  return exit_failure_found;
}

}  // namespace

void add_minimize_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<MinimizeArguments>();
  CLI::App* const command = app.add_subcommand("minimize", "make a failing schedule as small as it goes");
  command->add_option("file", arguments->file, "schedule file")->required();
  command->add_option("--seconds", arguments->seconds, "at most so long, in real time")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--out", arguments->out_file, "file for the small schedule, instead of the same");
  command->callback([arguments, &chosen] {
    chosen = [arguments](std::string_view program) { return minimize(*arguments, program); };
  });
}

}  // namespace ltsim
