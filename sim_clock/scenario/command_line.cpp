#include "sim_clock/scenario/command_line.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/program/launch.hpp"
#include "sim_clock/program/process_options.hpp"
#include "sim_clock/scenario/command.hpp"

namespace ltsim {
namespace {

/// "ltsim explore ... -- ./program ...", "ltsim explore ... --process image.so:...": goes on in the process of what is to be run.
void launch_programs(const std::vector<std::string>& words) {
  const auto separator = std::find(words.begin(), words.end(), "--");
  std::vector<std::string> command{words.begin(), separator};
  std::vector<std::string> program;
  if (separator != words.end()) {
    program.assign(separator + 1, words.end());
    if (program.empty()) throw UsageError{"no program follows \"--\""};
  } else {
    program = take_process_options(command);
    if (program.empty()) return;
    program.insert(program.begin(), processes_program);
  }
  command.push_back(scenario_name_of(program));
  throw UsageError{launch_program(command, program)};  // it has come back: that could not be
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  CLI::App app{
      "Runs scenarios in a world where threads, time and semaphores follow a seed.\n"
      "Exit code: 0 nothing found, 1 a failure was found, 2 bad usage or unreadable file, 3 our own fault;\n"
      "130 or 143 when SIGINT or SIGTERM ended a search that had found nothing."};
  app.require_subcommand(1);
  Command chosen;
  add_list_command(app, chosen);
  add_explore_command(app, chosen);
  add_prove_command(app, chosen);
  add_replay_command(app, chosen);
  add_minimize_command(app, chosen);
  add_zoo_command(app, chosen);
  add_fuzz_command(app, chosen);
  app.footer(process_options_help());
  const std::vector<std::string> words{argv, argv + argc};
  try {
    launch_programs(words);
    app.parse(argc, argv);
    try {
      return chosen(argv[0]);
    } catch (const ProgramIsNeeded& needed) {
      throw UsageError{launch_program(words, needed.program)};
    }
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
