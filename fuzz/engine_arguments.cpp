#include "fuzz/engine_arguments.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <unistd.h>

#include "fuzz/schedule_input.hpp"
#include "sim_clock/explore/schedule.hpp"

namespace fuzz {
namespace {

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

[[noreturn]] void refuse(std::string_view what, std::string_view why) {
  std::fprintf(stderr, "%.*s: %.*s\n", static_cast<int>(what.size()), what.data(),
               static_cast<int>(why.size()), why.data());
  std::_Exit(2);
}

/// The word behind "--NAME=", or nothing.
std::string_view value_of(std::string_view argument, std::string_view option) {
  return argument.starts_with(option) ? argument.substr(option.size()) : std::string_view{};
}

[[noreturn]] void replay(const ltsim::FuzzTarget& target, std::string_view path) {
  const auto schedule = ltsim::parse_schedule(read_file(path));
  if (!schedule) refuse(path, schedule.error().reason);
  try {
    const std::string unfit = target.scenario.replay(*schedule);
    std::fprintf(stderr, "passed%s%s\n",
                 unfit.empty() ? "" : ", though this no longer fits: ", unfit.c_str());
  } catch (const ltsim::BrokenPromise& broken) {
    std::fprintf(stderr, "%s\n", broken.what());
    std::abort();
  }
  std::_Exit(0);
}

[[noreturn]] void record(const ltsim::FuzzTarget& target, std::string_view path,
                         std::string_view input_path) {
  const std::string input = read_file(input_path);
  const ltsim::Schedule schedule = target.scenario.record(target, std::as_bytes(std::span{input}));
  std::ofstream file{std::string{path}, std::ios::binary};
  if (!(file << to_string(schedule)).flush()) refuse(path, "cannot be written");
  std::_Exit(0);
}

}  // namespace

void replace_schedules_by_inputs(std::span<char*> arguments) {
  for (char*& argument : arguments.subspan(1)) {
    const std::filesystem::path path = argument;
    if (path.extension() != ".schedule") continue;
    const auto input = input_of(read_file(path));
    if (!input) continue;
    static std::string name;
    name = std::filesystem::temp_directory_path() / ("fuzz-input-" + std::to_string(getpid()));
    std::ofstream{name, std::ios::binary} << *input;
    argument = name.data();
    std::atexit([] { std::filesystem::remove(name); });
  }
}

void obey_scenario_arguments(const ltsim::FuzzTarget& target, std::span<char*> arguments) {
  std::string_view schedule;
  for (const std::string_view argument : arguments.subspan(1)) {
    if (const auto name = value_of(argument, "--scenario="); !name.empty() && !target.scenario.steer(name))
      refuse(name, "this program has no scenario of that name");
    if (const auto path = value_of(argument, "--schedule="); !path.empty()) schedule = path;
  }
  for (const std::string_view argument : arguments.subspan(1)) {
    if (argument.starts_with('-')) continue;
    if (!schedule.empty()) record(target, schedule, argument);
    if (argument.ends_with(".schedule")) replay(target, argument);
  }
}

}  // namespace fuzz
