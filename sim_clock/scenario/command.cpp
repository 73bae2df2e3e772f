#include "sim_clock/scenario/command.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

namespace ltsim {

void add_memory_option(CLI::App& command, Memory& memory) {
  command
      .add_option_function<std::string>(
          "--memory",
          [&memory](const std::string& name) {
            memory = name == to_string(Memory::sc) ? Memory::sc : Memory::c11;
          },
          "sc: each load sees the latest store; c11: what C++ allows of atomic operations by their memory "
          "orders")
      ->check(CLI::IsMember({std::string{to_string(Memory::sc)}, std::string{to_string(Memory::c11)}}));
}

void add_findings_options(CLI::App& command, Findings& findings) {
  const auto add = [&command](const std::string& name, bool& is_failure, const std::string& what) {
    command
        .add_option_function<std::string>(
            name, [&is_failure](const std::string& text) { is_failure = text == "on"; },
            what + "; \"on\" unless given")
        ->check(CLI::IsMember({std::string{"on"}, std::string{"off"}}));
  };
  add("--races", findings.races, "whether a data race alone is a failure, in an execution that ends well");
  add("--leaks", findings.leaks,
      "whether memory that is lost, or a lock that is held at the end, is a failure");
}

std::string file_of_scenario(const std::string& folder, std::string_view scenario, std::string_view ending) {
  std::string file{scenario};
  std::replace(file.begin(), file.end(), '/', '-');
  return (std::filesystem::path{folder} / file.append(ending)).string();
}

const Scenario& scenario_of_name(const std::string& name) {
  const Scenario* const scenario = find_scenario(name);
  if (scenario == nullptr)
    throw UsageError{fmt::format("there is no scenario \"{}\"; \"ltsim list\" shows those there are", name)};
  return *scenario;
}

const Scenario& scenario_of(const Schedule& schedule) {
  if (!schedule.program.empty() && find_scenario(schedule.scenario) == nullptr)
    throw ProgramIsNeeded{schedule.program};
  return scenario_of_name(schedule.scenario);
}

Schedule read_schedule(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  if (!file) throw UsageError{fmt::format("{}: cannot be read", path)};
  const std::string text{std::istreambuf_iterator<char>{file}, {}};
  auto schedule = parse_schedule(text);
  if (!schedule)
    throw UsageError{fmt::format("{}:{}: {}", path, schedule.error().line, schedule.error().reason)};
  return std::move(*schedule);
}

FileResult write_file(const std::filesystem::path& path, const std::string& text) {
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  if (error) return tl::unexpected(error.message());
  errno = 0;
  std::ofstream file{path, std::ios::binary};
  const bool is_open = file.is_open();
  file << text;
  file.close();
  if (file) return {};
  const int reason = errno == 0 ? EIO : errno;
  if (is_open && std::filesystem::is_regular_file(path, error)) std::filesystem::remove(path, error);
  return tl::unexpected(std::generic_category().message(reason));
}

void write_asked_for_file(const std::filesystem::path& path, const std::string& text) {
  const FileResult written = write_file(path, text);
  if (!written) throw UsageError{fmt::format("{}: cannot be written: {}", path.string(), written.error())};
}

std::string as_shell_word(const std::string& text) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+:,=@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string{"'\\''"} : std::string{c};
  return quoted + "'";
}

}  // namespace ltsim
