// ltsim replay: runs a schedule again, and tells whether it still ends as recorded.

#include <memory>
#include <string>

#include <fmt/format.h>

#include "sim_clock/explore/duration_text.hpp"
#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/same_failure.hpp"
#include "sim_clock/scenario/command.hpp"
#include "sim_clock/trace/story.hpp"
#include "sim_clock/trace/text_trace.hpp"

namespace ltsim {
namespace {

struct ReplayArguments {
  std::string file;
  std::string trace;
  std::string out_file;
};

int replay(const ReplayArguments& arguments) {
  const Schedule schedule = read_schedule(arguments.file);
  const Scenario& scenario = scenario_of(schedule);
  World world;
  Explorer explorer{world};
  TextTrace trace{world};
  Story story{world, schedule};
  const bool tells_story = arguments.trace.empty();
  StepListener* const listener = tells_story ? static_cast<StepListener*>(&story) : &trace;
  const ReplayReport report = explorer.replay(scenario, schedule, listener);
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
  if (tells_story) fmt::print("{}", story.text(report.outcome));
  if (!world.output().empty())
    fmt::print("  output:\n{}{}", world.output(), world.output().ends_with('\n') ? "" : "\n");
  if (!same_failure(report.outcome, schedule)) {
    fmt::print("  not as recorded: {}{}{}\n", to_string(schedule.outcome),
               schedule.message.empty() ? "" : ": ", schedule.message);
    if (!schedule.input.empty() && schedule.message.find("Sanitizer") != std::string::npos) {
      fmt::print("  a sanitizer found that: run the target's program of a build with it, with this file\n");
    }
  }
  return report.outcome.passed() ? exit_nothing_found : exit_failure_found;
}

}  // namespace

void add_replay_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* const command = app.add_subcommand("replay", "run a schedule again");
  command->add_option("file", arguments->file, "schedule file")->required();
  CLI::Option* const trace = command->add_option("--trace", arguments->trace, "show every step: text")
                                 ->check(CLI::IsMember({"text"}));
  command->add_option("--out", arguments->out_file, "file for the trace, instead of the console")
      ->needs(trace);
  command->callback([arguments, &chosen] {
    chosen = [arguments](std::string_view /*program*/) { return replay(*arguments); };
  });
}

}  // namespace ltsim
