// How the run of a part program ended.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "kernel_mocks/logic_failure.hpp"
#include "kernel_mocks/nc_program.hpp"

namespace kernel_mocks {

enum class RunOutcome : std::uint8_t {
  ended,    ///< M2, M30, M99 or the last block before the closing %
  stopped,  ///< at M0 or M1, or in a feed hold, and nobody is there to press cycle start
  refused,  ///< a word that this machine cannot carry out; nothing of the program was done
  failed,   ///< the logic task could not go on
};

struct RunResult {
  RunOutcome outcome = RunOutcome::ended;
  /// Where and why the run ended, for people; empty when it ended.
  std::string message;
  /// For failed.
  std::optional<LogicFailure> failure;
};

/// A step of a run, or how the run ended there.
using RunStep = tl::expected<void, RunResult>;

/// "block N20 (line 2)"
[[nodiscard]] std::string place_of(const Block& block);
[[nodiscard]] RunResult failed_at(const std::string& where, const LogicFailure& failure);
[[nodiscard]] RunResult stopped_at(const std::string& where, const char* why);
/// The same as a step, if `done` is a failure.
[[nodiscard]] RunStep as_step(const std::string& where, const tl::expected<void, LogicFailure>& done);

}  // namespace kernel_mocks
