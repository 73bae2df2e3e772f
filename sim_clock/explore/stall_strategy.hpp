// A random walk with silences: one to three times a task gets no processor for long, while the others, and
// time, go on.
//
// A silence begins at a place drawn uniformly from the execution's choices and lasts for a number of events
// drawn log-uniformly, up to four times the length of an execution; an event is a step of another task or, when
// nobody else can run, the firing of a timer. So one silence spans any number of time-outs of the peer, which
// no number of coin flips would. Besides there are the slow moments of SamplingStrategy, measured in time.
#pragma once

#include "sim_clock/explore/sampling_strategy.hpp"

namespace ltsim {

class StallStrategy final : public SamplingStrategy {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "stall"; }
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  void learn(const ExecutionSummary& summary) noexcept override;

 private:
  TimeMode begin() noexcept override;
  [[nodiscard]] bool clock_goes_first(const SlowMomentChoice& choice) noexcept override;

  /// Counts one event. @return whether the silence goes on
  [[nodiscard]] bool pass_event() noexcept;

  Occasions silences_;
  TaskId silent_ = 0;
  std::uint64_t events_left_ = 0;  // of the silence; 0: nobody is silent
};

}  // namespace ltsim
