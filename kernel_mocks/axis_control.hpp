// Carries out the motion of a block, and keeps the PLC told of it: DEN, Z at the tool change position.
//
// Invariants
//   - DEN (M103) is off while a motion is under way.
//   - A motion at feed after a spindle start begins only with "spindle at speed" (M123); rapids do not wait.
//   - While the feed hold is active, or M125 is off, no axis moves. A dwell goes on.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "kernel_mocks/geometry_task.hpp"
#include "kernel_mocks/logic_task.hpp"
#include "kernel_mocks/motion.hpp"
#include "kernel_mocks/run_result.hpp"
#include "kernel_mocks/run_watch.hpp"
#include "kernel_mocks/runner_options.hpp"

namespace kernel_mocks {

class AxisControl {
 public:
  /// All must outlive it.
  AxisControl(LogicTask& logic_task, GeometryTask& geometry, RunWatch& watch, const RunnerOptions& options)
      : logic_task_{logic_task}, geometry_{geometry}, watch_{watch}, options_{options} {}

  /// At the program start: all axes stand at zero.
  RunStep begin_program();
  void spindle_given(SpindleEffect effect) noexcept;
  /// Before a motion at feed.
  RunStep wait_for_spindle(const Block& block);
  RunStep move(const Block& block, const Motion& motion);

 private:
  RunStep set_at_tool_change_position(const std::string& where, bool there);

  LogicTask& logic_task_;
  GeometryTask& geometry_;
  RunWatch& watch_;
  const RunnerOptions& options_;
  std::optional<bool> at_tool_change_position_;
  bool spindle_has_started_ = false;
};

}  // namespace kernel_mocks
