// Follows one execution step by step: to record a schedule, to find the place where a recorded choice
// applies, to write a trace. A world without a listener pays one predictable branch per step.
#pragma once

#include <string_view>

#include "sim_clock/clock/virtual_clock.hpp"
#include "sim_clock/world/operation.hpp"

namespace ltsim {

struct Task;

/// What an operation came to that found an older store, or has stored something where newer stores are.
struct OlderStore {
  std::uint64_t found = 0;                ///< by a load or an update
  std::uint64_t stored = 0;               ///< by a store or an update; of what only loads, what it found
  TaskId writer = VirtualClock::no_task;  ///< of what was found; no_task: it was there at first
  std::uint32_t newer_count = 0;          ///< stores of that place that are newer
};

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
  /// The operation that `task` performs, on a weak memory, has not taken the latest store.
  virtual void older(const Task& /*task*/, const OlderStore& /*taken*/) noexcept {}
  /// A remark of the scenario or of its checks.
  virtual void notes(std::string_view text) noexcept = 0;

 protected:
  StepListener() = default;
  StepListener(const StepListener&) = default;
  StepListener& operator=(const StepListener&) = default;
};

}  // namespace ltsim
