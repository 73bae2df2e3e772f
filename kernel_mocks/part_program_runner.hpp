// Runs a part program block by block: the kernel's main loop.
//
// Motion is noted and takes no time. Functions go to the PLC through the logic task, in the order of the
// block's plan. A block whose last function is acknowledged late (Acknowledgement::before_next_function) does
// not wait; its FIN is taken before the next function is given, or at the end of the program.
//
// A run that fails, or ends at a stop, resets the PLC: nobody is there who would press cycle start.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "kernel_mocks/block_plan.hpp"
#include "kernel_mocks/logic_task.hpp"
#include "kernel_mocks/nc_program.hpp"

namespace kernel_mocks {

class PartProgramObserver {
 public:
  virtual ~PartProgramObserver() = default;

  /// The block moves an axis or dwells.
  virtual void motion_noted(const Block& /*block*/) noexcept {}
  /// The PLC has done all functions of this request.
  virtual void acknowledged(const Block& /*block*/, const FunctionRequest& /*request*/,
                            std::chrono::nanoseconds /*duration*/) noexcept {}
  /// The program stops at this block, and goes on at once.
  virtual void stop_passed(const Block& /*block*/) noexcept {}

 protected:
  PartProgramObserver() = default;
  PartProgramObserver(const PartProgramObserver&) = default;
  PartProgramObserver& operator=(const PartProgramObserver&) = default;
};

struct RunnerOptions {
  /// M0 (and M1, when its switch is on) goes on at once, as if cycle start had been pressed.
  bool continue_at_stop = false;
  /// The operator's switch for M1: off, M1 does nothing and the PLC does not see it.
  bool optional_stop = false;
};

enum class RunOutcome : std::uint8_t {
  ended,    ///< M2, M30, M99 or the last block before the closing %
  stopped,  ///< at M0 or M1
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

class PartProgramRunner {
 public:
  /// @param observer  may be nullptr
  PartProgramRunner(LogicTask& logic_task, const RunnerOptions& options,
                    PartProgramObserver* observer = nullptr);

  [[nodiscard]] RunResult run(const Program& program);

 private:
  tl::expected<ProgramFlow, RunResult> run_block(const Block& block);
  tl::expected<void, RunResult> give(const Block& block, const FunctionRequest& request);
  tl::expected<void, RunResult> finish_pending();
  RunResult failed(const std::string& where, const LogicFailure& failure);

  struct Pending {
    const Block* block;
    FunctionRequest request;
  };

  LogicTask& logic_task_;
  RunnerOptions options_;
  PartProgramObserver* observer_;
  std::optional<Pending> pending_;
};

}  // namespace kernel_mocks
