// Runs a part program block by block: the kernel's main loop.
//
// A block is split: its motion goes to the geometry task, its functions to the logic task, each a thread; the
// runner feeds both and waits as the function's Acknowledgement demands. One handshake at a time: a function that
// is not waited for is finished before the next one is given, or at the end of the program.
//
// Invariants
//   - DEN (M103) is off while a motion is under way, and on before a function of the block's end is given.
//   - A motion at feed after a spindle start begins only with "spindle at speed" (M123); rapids do not wait.
//   - While the feed hold is active no block begins and no axis moves; a handshake under way goes on.
//   - While M125 is off no axis moves.
//
// A run that fails, or ends at a stop, resets the PLC: nobody is there who would press cycle start.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "kernel_mocks/block_plan.hpp"
#include "kernel_mocks/function_worker.hpp"
#include "kernel_mocks/geometry_task.hpp"
#include "kernel_mocks/logic_task.hpp"
#include "kernel_mocks/motion.hpp"
#include "kernel_mocks/nc_program.hpp"
#include "kernel_mocks/operator_panel.hpp"

namespace kernel_mocks {

class PartProgramObserver {
 public:
  virtual ~PartProgramObserver() = default;

  using TimePoint = std::chrono::steady_clock::time_point;

  /// The PLC is ready, "program running" is on.
  virtual void program_begun(TimePoint /*at*/) noexcept {}
  /// The strobes of the request are up.
  virtual void given(const Block& /*block*/, const FunctionRequest& /*request*/, TimePoint /*at*/) noexcept {}
  /// No FIN for a request whose strobes were up.
  virtual void not_acknowledged(const Block& /*block*/, const FunctionRequest& /*request*/,
                                const LogicFailure& /*failure*/) noexcept {}
  /// The block moved an axis or dwelled.
  /// @param duration  holds included; 0 when motion takes no time
  /// @param reached   false: the run ended before the motion did
  virtual void moved(const Block& /*block*/, MotionKind /*kind*/, std::chrono::nanoseconds /*duration*/,
                     bool /*reached*/) noexcept {}
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
  /// Must outlive the runner.
  const MachineTable* machine_table = &MachineTable::standard();
  AxisOptions axes{};
  /// Longest wait for "spindle at speed" before a motion at feed.
  std::chrono::nanoseconds spindle_timeout = std::chrono::seconds{10};
  /// May be nullptr: nobody is there. With a panel a stop waits for cycle start.
  OperatorPanel* panel = nullptr;
  /// May be nullptr; presses the panel, which must be there.
  Operator* operator_ = nullptr;
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
  using Step = tl::expected<void, RunResult>;
  struct Pending {
    const Block* block;
    FunctionRequest request;
  };
  /// The threads of one run.
  struct Tasks {
    explicit Tasks(LogicTask& logic_task) : geometry{notifier}, functions{logic_task, notifier} {}
    Notifier notifier;
    GeometryTask geometry;
    FunctionWorker functions;
  };

  RunResult run_blocks(const Program& program);
  tl::expected<ProgramFlow, RunResult> run_block(const Block& block);
  Step give(const Block& block, const FunctionRequest& request);
  Step finish_pending();
  Step finish_pending_if(Acknowledgement acknowledgement);
  void abandon_pending(const RunResult& why);
  Step move(const Block& block, const Motion& motion);
  Step carry_out(const Block& block, const Motion& motion);
  Step wait_for_spindle(const Block& block);
  Step wait_at_stop(const Block& block);
  Step wait_while_held(const Block& block);
  Step set_held(const std::string& where, bool held);
  Step set_at_tool_change_position(const std::string& where, bool there);
  /// Waits until `ready()`, and looks at the operator's panel meanwhile.
  template <typename Ready>
  Step wait_until(const std::string& where, Ready ready);
  Step look_at_panel(const std::string& where);
  Step obey(const std::string& where, OperatorEvent event);
  [[nodiscard]] bool is_attended() const;
  [[nodiscard]] Step check(const std::string& where, const tl::expected<void, LogicFailure>& done) const;

  LogicTask& logic_task_;
  RunnerOptions options_;
  PartProgramObserver* observer_;
  std::optional<Tasks> tasks_;
  std::optional<Pending> pending_;
  std::optional<MotionPlanner> planner_;
  std::chrono::steady_clock::time_point begun_;
  std::optional<bool> at_tool_change_position_;
  bool optional_stop_ = false;
  bool held_ = false;
  bool stopped_ = false;
  bool spindle_has_started_ = false;
};

}  // namespace kernel_mocks
