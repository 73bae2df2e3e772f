// Follows one execution step by step: to record a schedule, to find the place where a recorded choice
// applies, to write a trace. A world without a listener pays one predictable branch per step.
#pragma once

#include <string_view>

#include "sim_clock/clock/virtual_clock.hpp"
#include "sim_clock/world/operation.hpp"

namespace ltsim {

struct Task;

class StepListener {
 public:
  virtual ~StepListener() = default;

  /// `task` has arrived at the scheduling point before `operation`; the choices that follow are made there.
  virtual void arrives(const Task& task, const Operation& operation) noexcept = 0;
  /// `task` goes on and performs the operation.
  virtual void performs(const Task& task, const Operation& operation) noexcept = 0;
  /// `task` cannot go on with its pending operation; the choice of the next task follows.
  virtual void blocks(const Task& task) noexcept = 0;
  /// `task` gets no processor for `duration`, though it could run; the choice of the next task follows.
  virtual void held_up(const Task& /*task*/, SimTime /*duration*/) noexcept {}
  /// `task`, which was held up, stands again before its pending operation; the choices that follow are made there.
  virtual void goes_on(const Task& /*task*/) noexcept {}
  /// `task` has ended; the choice of the next task follows.
  virtual void ends(const Task& task) noexcept = 0;
  /// The scenario asks for a value, in a task or (null) outside; the choice follows.
  virtual void asks(const Task* task, std::string_view what) noexcept = 0;
  /// The operation that `task` performs, on a weak memory, has not taken the latest store: it has found `value`, or stored it
  /// there, where so many stores of that place are newer.
  virtual void older(const Task& /*task*/, std::uint64_t /*value*/, std::uint32_t /*age*/) noexcept {}
  /// A remark of the scenario or of its checks.
  virtual void notes(std::string_view text) noexcept = 0;

 protected:
  StepListener() = default;
  StepListener(const StepListener&) = default;
  StepListener& operator=(const StepListener&) = default;
};

}  // namespace ltsim
