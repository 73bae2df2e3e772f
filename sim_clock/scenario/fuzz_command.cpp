// ltsim fuzz: builds a fuzz target with its engine, lets it run, and hands each finding over as a schedule file.

#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/minimizer.hpp"
#include "sim_clock/scenario/command.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace ltsim {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds time_to_make_it_small{10};

struct FuzzArguments {
  std::vector<std::string> targets;
  std::string source_folder = ".";
  std::string out_folder = "out";
  std::string scenario;  ///< to steer in place of the target's own; empty: none
  double seconds = 60;
  unsigned jobs = 1;
};

/// Where a target's files lie.
struct FuzzFolders {
  fs::path program;
  fs::path seeds;       ///< of the project: read only
  fs::path found;       ///< inputs that reached something new, kept from run to run
  fs::path artifacts;   ///< inputs that failed in this run
  fs::path dictionary;  ///< need not exist
  fs::path options;     ///< need not exist
};

/// How the program of a target is called, up to where the engine's own arguments begin.
std::string command_of(const FuzzArguments& arguments, const FuzzFolders& folders) {
  std::string command = as_shell_word(folders.program.string());
  if (!arguments.scenario.empty()) command += " --scenario=" + as_shell_word(arguments.scenario);
  return command;
}

std::string read_file(const fs::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

/// Runs a command of the shell, its output passed on. @return its exit code, or -1 if it was killed
int run(const std::string& command) {
  std::fflush(nullptr);
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Builds fuzz-NAME. @return where it lies
fs::path build(const FuzzArguments& arguments, const FuzzTarget& target) {
  const fs::path source = arguments.source_folder;
  if (!fs::exists(source / "CMakePresets.json")) {
    throw UsageError{fmt::format(
        "{}: holds no CMakePresets.json; run \"ltsim fuzz\" in the project's folder, or say --source FOLDER",
        source.string())};
  }
  const std::string preset = target.needs_world() ? "fuzz-world" : "fuzz";
  const std::string log = (fs::path{"build"} / (preset + ".log")).string();
  fmt::print("building fuzz-{} in build/{}\n", target.name, preset);
  const std::string command = fmt::format(
      "cd {} && mkdir -p build && (cmake --preset {} && cmake --build --preset {} --target fuzz-{}) >{} 2>&1",
      as_shell_word(source.string()), preset, preset, target.name, log);
  if (run(command) != 0) {
    throw UsageError{
        fmt::format("fuzz-{} cannot be built; what was said is in {}", target.name, (source / log).string())};
  }
  return source / "build" / preset / "bin" / fmt::format("fuzz-{}", target.name);
}

FuzzFolders folders_of(const FuzzArguments& arguments, const FuzzTarget& target, fs::path program) {
  const fs::path fuzz = fs::path{arguments.source_folder} / "fuzz";
  const fs::path out = fs::path{arguments.out_folder} / "fuzz" / target.name;
  const std::string name{target.name};
  return {.program = std::move(program),
          .seeds = fuzz / "corpus" / name,
          .found = out / "corpus",
          .artifacts = out / "artifacts",
          .dictionary = fuzz / (name + ".dict"),
          .options = fuzz / (name + ".options")};
}

/// "-max_len=600 -use_value_profile=1" of a file as the fuzzing services have it: lines "max_len = 600" below "[libfuzzer]".
std::string engine_options(const fs::path& path) {
  std::ifstream file{path};
  std::string options;
  bool is_ours = false;
  for (std::string line; std::getline(file, line);) {
    std::erase_if(line, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
    if (line.starts_with('[')) {
      is_ours = line == "[libfuzzer]";
    } else if (is_ours && !line.empty() && !line.starts_with('#')) {
      options += " -" + line;
    }
  }
  return options;
}

/// Lets the engine run. @return the inputs that failed
std::vector<fs::path> fuzz(const FuzzArguments& arguments, const FuzzFolders& folders) {
  fs::create_directories(folders.found);
  fs::remove_all(folders.artifacts);
  fs::create_directories(folders.artifacts);
  std::string command = fmt::format(
      "{} {} {} -artifact_prefix={}/ -max_total_time={} -print_final_stats=1 -timeout=10{}",
      command_of(arguments, folders), as_shell_word(folders.found.string()),
      fs::exists(folders.seeds) ? as_shell_word(folders.seeds.string()) : "",
      as_shell_word(folders.artifacts.string()), static_cast<unsigned long>(std::max(1.0, arguments.seconds)),
      engine_options(folders.options));
  if (fs::exists(folders.dictionary)) command += " -dict=" + as_shell_word(folders.dictionary.string());
  if (arguments.jobs > 1) command += fmt::format(" -fork={}", arguments.jobs);
  fmt::print("{}\n", command);
  run(command);
  std::vector<fs::path> failed;
  for (const auto& entry : fs::directory_iterator(folders.artifacts)) failed.push_back(entry.path());
  std::ranges::sort(failed);
  return failed;
}

/// What a sanitizer, or the engine itself, says of an input.
std::string engine_verdict(const FuzzFolders& folders, const fs::path& input) {
  const fs::path log = folders.artifacts.string() + ".log";
  run(fmt::format("{} -timeout=10 {} >{} 2>&1", as_shell_word(folders.program.string()),
                  as_shell_word(input.string()), as_shell_word(log.string())));
  std::ifstream file{log};
  for (std::string line; std::getline(file, line);) {
    for (const std::string_view mark : {"ERROR: ", "runtime error: "}) {
      const std::size_t at = line.find(mark);
      if (at != std::string::npos) return line.substr(at + mark.size());
    }
  }
  return "the engine stopped";
}

/// For what only the engine's program sees: the engine itself looks for fewer bytes that fail.
/// @return the input itself if there are none
fs::path made_small_by_engine(const FuzzFolders& folders, const fs::path& input) {
  const fs::path small = folders.artifacts.string() + ".small";
  fs::remove(small);
  run(fmt::format("{} -minimize_crash=1 -max_total_time={} -timeout=10 -exact_artifact_path={} {} >{} 2>&1",
                  as_shell_word(folders.program.string()), time_to_make_it_small.count(),
                  as_shell_word(small.string()), as_shell_word(input.string()),
                  as_shell_word(folders.artifacts.string() + ".log")));
  return fs::exists(small) && fs::file_size(small) < fs::file_size(input) ? small : input;
}

/// The program itself says what the bytes choose: they count decisions, and this program may have others.
Schedule recorded_schedule(const FuzzArguments& arguments, const FuzzFolders& folders,
                           const fs::path& input) {
  const fs::path path = folders.artifacts.string() + ".schedule";
  const std::string command = fmt::format("{} --schedule={} {}", command_of(arguments, folders),
                                          as_shell_word(path.string()), as_shell_word(input.string()));
  if (run(command) != 0) throw UsageError{fmt::format("no schedule could be recorded: {}", command)};
  return read_schedule(path.string());
}

void set_input(Schedule& schedule, const FuzzTarget& target, const fs::path& path) {
  const std::string bytes = read_file(path);
  schedule.input.clear();
  for (const std::string_view record : target.records(bytes)) schedule.input.emplace_back(record);
}

Schedule schedule_of(const FuzzArguments& arguments, const FuzzTarget& target, const FuzzFolders& folders,
                     const fs::path& input) {
  if (target.needs_world()) return recorded_schedule(arguments, folders, input);
  Schedule schedule;
  schedule.scenario = "fuzz/" + std::string{target.name};
  set_input(schedule, target, input);
  World world;
  const ReplayReport report = Explorer{world}.replay(scenario_of_name(schedule.scenario), schedule, nullptr);
  schedule.outcome = report.outcome.kind;
  schedule.message = one_line(report.outcome.message);
  if (report.outcome.passed()) {
    const fs::path small = made_small_by_engine(folders, input);
    set_input(schedule, target, small);
    schedule.outcome = OutcomeKind::crash;
    schedule.message = one_line(engine_verdict(folders, small));
    return schedule;
  }
  return Minimizer{world, scenario_of_name(schedule.scenario)}
      .minimize(schedule, {.seconds_max = time_to_make_it_small})
      .schedule;
}

void tell(const FuzzTarget& target, const Schedule& schedule, const FuzzFolders& folders,
          const fs::path& path, std::string_view program) {
  fmt::print("\n{}  {}: {}\n", schedule.scenario, to_string(schedule.outcome), schedule.message);
  for (const std::string& line : input_lines(schedule)) fmt::print("    {}\n", line);
  for (const Deviation& line : schedule.deviations) fmt::print("    {}\n", to_string(line));
  fmt::print("  replay:  {} replay {}\n", as_shell_word(std::string{program}), as_shell_word(path.string()));
  if (target.needs_world()) return;
  fmt::print("  with sanitizers:  {} {}\n", as_shell_word(folders.program.string()),
             as_shell_word(path.string()));
}

/// @return how many inputs failed
std::size_t fuzz_target(const FuzzArguments& arguments, const FuzzTarget& target, std::string_view program) {
  const FuzzFolders folders = folders_of(arguments, target, build(arguments, target));
  const std::vector<fs::path> failed = fuzz(arguments, folders);
  for (std::size_t i = 0; i < failed.size(); ++i) {
    const fs::path path =
        fs::path{arguments.out_folder} /
        fmt::format("fuzz-{}{}.schedule", target.name, i == 0 ? "" : fmt::format("-{}", i + 1));
    const Schedule schedule = schedule_of(arguments, target, folders, failed[i]);
    write_asked_for_file(path, to_string(schedule));
    tell(target, schedule, folders, path, program);
  }
  return failed.size();
}

int fuzz_all(const FuzzArguments& arguments, std::string_view program) {
  std::vector<const FuzzTarget*> chosen;
  for (const std::string& name : arguments.targets) {
    chosen.push_back(find_fuzz_target(name));
    if (chosen.back() == nullptr) {
      std::vector<std::string_view> known;
      for (const FuzzTarget& target : fuzz_targets()) known.push_back(target.name);
      throw UsageError{
          fmt::format("there is no fuzz target \"{}\"; there are: {}", name, fmt::join(known, ", "))};
    }
  }
  const auto cannot_steer = [](const FuzzTarget* target) { return !target->needs_world(); };
  if (!arguments.scenario.empty() && std::ranges::any_of(chosen, cannot_steer))
    throw UsageError{"--scenario is for targets whose bytes are the choices of a scenario"};
  std::size_t failed = 0;
  for (const FuzzTarget* const target : chosen) {
    const std::size_t of_target = fuzz_target(arguments, *target, program);
    fmt::print("fuzz/{}  {}\n", target->name,
               of_target == 0 ? "nothing found" : fmt::format("{} inputs failed", of_target));
    failed += of_target;
  }
  return failed == 0 ? exit_nothing_found : exit_failure_found;
}

}  // namespace

void add_fuzz_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<FuzzArguments>();
  CLI::App* const command = app.add_subcommand(
      "fuzz", "build a fuzz target with its engine and sanitizers, run it, write findings as schedules");
  command->add_option("targets", arguments->targets, "names without \"fuzz/\"")->required();
  command->add_option("--seconds", arguments->seconds, "of real time, for each target")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--jobs", arguments->jobs, "processes of the engine")
      ->capture_default_str()
      ->check(CLI::Range(1U, 64U));
  command->add_option("--scenario", arguments->scenario,
                      "for a target whose bytes are choices: steer this scenario of its program instead");
  command->add_option("--source", arguments->source_folder, "the project's folder, with CMakePresets.json")
      ->capture_default_str();
  command->add_option("--out", arguments->out_folder, "folder for schedules, and for what the engine found")
      ->capture_default_str();
  command->callback([arguments, &chosen] {
    chosen = [arguments](std::string_view program) { return fuzz_all(*arguments, program); };
  });
}

}  // namespace ltsim
