// What the executions of whole programs have in common, of one program alone or of several as processes of one world: each begins as the
// programs were before their main(), and what they write is kept.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim_clock/program/kept_state.hpp"
#include "sim_clock/program/open_descriptors.hpp"
#include "sim_clock/program/output_capture.hpp"
#include "sim_clock/scenario/scenario.hpp"

namespace ltsim {

/// What a parent gets to know of an exit status.
inline constexpr int exit_status_mask = 0xff;

class ProgramExecutions {
 public:
  /// The programs have been loaded, and nothing of a main() has run yet.
  ProgramExecutions();

  /// For this process and those that it forks: Scenario::prepare.
  void prepare();
  /// Puts everything back that an execution before has changed.
  void begin();
  /// World::run(); what the programs write meanwhile becomes World::output().
  void run(World& world);
  /// As the process of that number begins again: KeptState::restore_image().
  void begin_again(std::size_t image) { kept_.restore_image(image); }

 private:
  void tell_left_open();

  KeptState kept_;
  std::uint64_t count_ = 0;  // that have begun in this process
  std::optional<OpenDescriptors> descriptors_;
  std::optional<OutputCapture> capture_;
  std::atomic<bool>* has_told_left_open_;  // shared with the processes that are forked from here on
};

/// Runs the command line of ltsim over the scenario alone.
/// @param scenario  its name and description outlive the call
/// @param command   e.g. {"ltsim", "explore", "--seed", "2", "bank"}
/// @return          the exit code
[[nodiscard]] int run_program_command(Scenario scenario, const std::vector<std::string>& command);

}  // namespace ltsim
