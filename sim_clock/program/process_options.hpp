// Which programs are the processes of one world, and what may happen to them: the command line of ltsim-processes, which
// "ltsim explore --process a.so:... --service b.so:..." is short for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "sim_clock/world/faults.hpp"

namespace ltsim {

/// The program that loads them, beside ltsim itself.
inline constexpr const char* processes_program = "ltsim-processes";

struct ProcessOptions {
  std::string name;                    ///< "kernel" of "build/kernel.so"; the second one "kernel-2"
  std::vector<std::string> arguments;  ///< the image's path first
  bool is_service = false;
  std::optional<CrashGrant> crash{};
  unsigned stalls = 0;
};

struct WorldOptions {
  std::vector<ProcessOptions> processes;  ///< services first
  struct Fault {
    FaultKind kind = FaultKind::interrupt;
    unsigned times = 1;
  };
  std::vector<Fault> faults;
  std::vector<int> exit_statuses{0};  ///< that are no failure
  std::uint64_t points_max = 0;       ///< 0: the world's own
  std::optional<SimTime> within{};    ///< longer, and the execution fails
  bool is_steady = false;             ///< World::set_steady()

  /// "kernel+emulator": of the scenario.
  [[nodiscard]] std::string name() const;
};

/// @param arguments  without the program's path
/// @return           or what is wrong with them, and what would be right
[[nodiscard]] tl::expected<WorldOptions, std::string> parse_process_options(
    const std::vector<std::string>& arguments);

/// Takes the options for ltsim-processes out of a command of ltsim.
/// @param command  "ltsim explore --process a.so --seed 2"; then "ltsim explore --seed 2"
/// @return         what was taken; nothing: there was none
[[nodiscard]] std::vector<std::string> take_process_options(std::vector<std::string>& command);

/// What they are, for the help of ltsim.
[[nodiscard]] std::string process_options_help();

}  // namespace ltsim
