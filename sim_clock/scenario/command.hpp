// What the subcommands of ltsim share. Each has a file of its own (explore_command.cpp ...) with one function
// that adds it to the command line; command_line.cpp puts them together.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <tl/expected.hpp>

#include "sim_clock/explore/schedule.hpp"
#include "sim_clock/scenario/scenario.hpp"

namespace ltsim {

inline constexpr int exit_nothing_found = 0;
inline constexpr int exit_failure_found = 1;
inline constexpr int exit_bad_usage = 2;
inline constexpr int exit_our_fault = 3;
/// Interrupted, with nothing found until then: what a shell makes of a program that dies of the signal.
[[nodiscard]] constexpr int exit_of_signal(int signal) noexcept { return 128 + signal; }

/// Bad usage or an unreadable file: told to the user, exit code 2.
struct UsageError {
  std::string message;
};

/// A subcommand as the user gave it, ready to run.
/// @param program  how ltsim was called, for lines to be pasted
/// @return         the exit code
/// @throw          UsageError, Explorer::NotSimulable
using Command = std::function<int(std::string_view program)>;

// Each adds one subcommand; when that is the one on the command line, parsing sets `chosen`.
void add_fuzz_command(CLI::App& app, Command& chosen);
void add_list_command(CLI::App& app, Command& chosen);
void add_explore_command(CLI::App& app, Command& chosen);
void add_minimize_command(CLI::App& app, Command& chosen);
void add_prove_command(CLI::App& app, Command& chosen);
void add_replay_command(CLI::App& app, Command& chosen);
void add_zoo_command(CLI::App& app, Command& chosen);

/// --memory sc|c11
void add_memory_option(CLI::App& command, Memory& memory);

/// --races on|off, --leaks on|off
void add_findings_options(CLI::App& command, Findings& findings);

/// "out/paper-time-out.schedule" for what belongs to paper/time-out.
[[nodiscard]] std::string file_of_scenario(const std::string& folder, std::string_view scenario,
                                           std::string_view ending);

/// @throw UsageError if there is none of that name
[[nodiscard]] const Scenario& scenario_of_name(const std::string& name);

/// The command is for this program's own process.
struct ProgramIsNeeded {
  std::vector<std::string> program;  ///< its path and its arguments
};
/// @throw UsageError if there is no such scenario; ProgramIsNeeded if it is a whole program and not this one
[[nodiscard]] const Scenario& scenario_of(const Schedule& schedule);

/// @throw UsageError if the file cannot be read or is no schedule
[[nodiscard]] Schedule read_schedule(const std::string& path);

/// Nothing, or why the file cannot be written.
using FileResult = tl::expected<void, std::string>;

/// Makes the folders that are missing, and leaves no half of a file behind.
[[nodiscard]] FileResult write_file(const std::filesystem::path& path, const std::string& text);
/// @throw UsageError if the file cannot be written
void write_asked_for_file(const std::filesystem::path& path, const std::string& text);

/// Ready to be pasted: in quotes if a shell would read it otherwise.
[[nodiscard]] std::string as_shell_word(const std::string& text);

}  // namespace ltsim
