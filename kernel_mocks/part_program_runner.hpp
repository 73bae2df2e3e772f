// Runs a part program block by block: the kernel's main loop.
//
// A block is split: its motion goes to the geometry task, its functions to the logic task, each a thread; the
// runner feeds both and waits as the function's Acknowledgement demands. One handshake at a time: a function that
// is not waited for is finished before the next one is given, or at the end of the program.
//
// Invariants
//   - DEN (M103) is on before a function of the block's end is given.
//   - While the feed hold is active no block begins; a handshake under way goes on.
//   - No strobe rises after the run was ended by the operator, by SIGINT or by a fault of the PLC.
//
// A run that fails, or ends at a stop, resets the PLC: nobody is there who would press cycle start.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include <tl/expected.hpp>

#include "kernel_mocks/axis_control.hpp"
#include "kernel_mocks/block_plan.hpp"
#include "kernel_mocks/function_worker.hpp"
#include "kernel_mocks/geometry_task.hpp"
#include "kernel_mocks/logic_task.hpp"
#include "kernel_mocks/motion.hpp"
#include "kernel_mocks/nc_program.hpp"
#include "kernel_mocks/run_result.hpp"
#include "kernel_mocks/run_watch.hpp"
#include "kernel_mocks/runner_options.hpp"

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

class PartProgramRunner {
 public:
  /// @param observer  may be nullptr
  PartProgramRunner(LogicTask& logic_task, const RunnerOptions& options,
                    PartProgramObserver* observer = nullptr);

  [[nodiscard]] RunResult run(const Program& program);

 private:
  struct Pending {
    const Block* block;
    FunctionRequest request;
    /// The observer knows of it.
    bool told = false;
  };
  /// What lives as long as one run: its threads, and who waits for them.
  struct Tasks {
    Tasks(LogicTask& logic_task, const RunnerOptions& options)
        : geometry{notifier},
          functions{logic_task, notifier},
          watch{logic_task, geometry, notifier, options},
          axes{logic_task, geometry, watch, options} {}
    Notifier notifier;
    GeometryTask geometry;
    FunctionWorker functions;
    RunWatch watch;
    AxisControl axes;
  };

  RunResult run_blocks(const Program& program);
  tl::expected<ProgramFlow, RunResult> run_block(const Block& block);
  void tell_given();
  RunStep give(const Block& block, const FunctionRequest& request);
  RunStep finish_pending();
  RunStep finish_pending_if(Acknowledgement acknowledgement);
  void abandon_pending(const RunResult& why);
  RunStep move(const Block& block, const Motion& motion);

  LogicTask& logic_task_;
  RunnerOptions options_;
  PartProgramObserver* observer_;
  std::optional<Tasks> tasks_;
  std::optional<Pending> pending_;
  std::optional<MotionPlanner> planner_;
};

}  // namespace kernel_mocks
