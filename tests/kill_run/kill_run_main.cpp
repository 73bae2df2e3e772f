// kill-run: a kernel and an emulator as real processes over real shared memory, killed with SIGKILL at random and started
// again; in the end every request is accounted for (README.md).
//
// Exit codes: 0 all is accounted for; 1 an invariant does not hold; 2 bad usage; 3 our own fault; 130 interrupted, and what
// was run until then is accounted for.
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "tests/kill_run/own_shared_memory.hpp"
#include "tests/kill_run/report.hpp"
#include "tests/kill_run/supervisor.hpp"

namespace {

using kill_run::RunOptions;
using protocol::hardened::Options;
using protocol::hardened::Rules;

constexpr int exit_accused = 1;
constexpr int exit_usage = 2;
constexpr int exit_own_fault = 3;
constexpr int exit_interrupted = 130;

std::atomic<bool> interrupted{false};

/// M9 is left out: without it nothing goes wrong while sequence numbers differ.
const std::map<std::string, bool Rules::*> rules{{"M1", &Rules::answer_by_swap},
                                                 {"M2", &Rules::withdraw_by_swap},
                                                 {"M3", &Rules::phase_decides},
                                                 {"M4", &Rules::duplicate_store},
                                                 {"M5", &Rules::generation_advances},
                                                 {"M6", &Rules::doubt_is_kept},
                                                 {"M7", &Rules::query_from_first_generation},
                                                 {"M8", &Rules::empties_before_look}};

int run(const RunOptions& options) {
  struct sigaction stop = {};
  stop.sa_handler = [](int) { interrupted.store(true); };
  ::sigaction(SIGINT, &stop, nullptr);

  fmt::print("kill-run: {} kills, seed {}, segment {} in {} /dev/shm\n", options.kills, options.seed,
             options.name, options.owns_shared_memory ? "its own" : "the machine's");
  const kill_run::RunResult result = kill_run::Supervisor(options, interrupted).run();
  fmt::print("{}", kill_run::to_text(result));

  const auto& accusations = result.accounts.accusations;
  if (!accusations.empty()) {
    fmt::print("{}", kill_run::to_text(accusations));
    return exit_accused;
  }
  fmt::print("kill-run: every request is accounted for\n");
  return result.was_interrupted ? exit_interrupted : 0;
}

}  // namespace

int main(int argc, char** argv) {
  RunOptions options;
  options.name = fmt::format("ltsim-kill-run-{}", ::getpid());
  CLI::App app{
      "Kills a kernel and an emulator at random moments, starts them again, and accounts for every request."};
  app.add_option("--kills", options.kills, "How many processes are killed")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Of what is drawn; how the system schedules is not")
      ->capture_default_str();
  app.add_option("--doorbells", options.doorbells, "two, or one: the kernel polls")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Options::Doorbells>{
          {"two", Options::Doorbells::two}, {"one", Options::Doorbells::one}}));
  app.add_option("--side", options.victims, "Who is killed: kernel, emulator, either")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, kill_run::Victims>{{"kernel", kill_run::Victims::kernel},
                                                   {"emulator", kill_run::Victims::emulator},
                                                   {"either", kill_run::Victims::either}}));
  app.add_option("--name", options.name, "Of the segment; nothing of that name may be there");
  app.add_option_function<std::string>(
         "--without", [&options](const std::string& rule) { options.rules.*rules.at(rule) = false; },
         "Takes a rule of the protocol away (protocol/README.md), to see the run accuse: M1 to M8")
      ->check(CLI::IsMember(rules));
  app.footer(
      "Exit codes: 0 all is accounted for, 1 an invariant does not hold, 2 bad usage, 3 own fault, "
      "130 interrupted.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : exit_usage;
  }
  try {
    options.owns_shared_memory = kill_run::enter_own_shared_memory();
    if (!kill_run::named_objects(options).empty()) {
      fmt::print(stderr, "kill-run: there is a segment {} already\n", options.name);
      return exit_usage;
    }
    return run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "kill-run: {}\n", error.what());
    return exit_own_fault;
  }
}
