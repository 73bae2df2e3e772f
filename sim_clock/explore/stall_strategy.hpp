// A random walk with silences: one to three times a task gets no processor for long, while the others, and
// time, go on.
//
// A silence begins before an operation that matters, drawn uniformly from those of the execution, and lasts
// until the others have
//   changed something   1 to 63 times: stored, posted, unlocked; or
//   passed events       up to eight times the length of an execution: steps, or the firing of a timer when
//                       nobody else can run;
// both drawn log-uniformly. So one silence spans any number of looks or of time-outs of the peer, which no number
// of coin flips would. Besides there are the slow moments of SamplingStrategy, measured in time.
#pragma once

#include "sim_clock/explore/sampling_strategy.hpp"

namespace ltsim {

class StallStrategy final : public SamplingStrategy {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "stall"; }
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  void learn(const ExecutionSummary& summary) noexcept override;
  [[nodiscard]] bool follows_steps() const noexcept override { return true; }
  void performs(TaskId task, const Operation& operation) noexcept override;

 private:
  static constexpr TaskId nobody = VirtualClock::no_task;

  void begin_silence(TaskId task) noexcept;
  void count_down() noexcept;

  TimeMode begin() noexcept override;
  [[nodiscard]] bool clock_goes_first(const SlowMomentChoice& choice) noexcept override;

  [[nodiscard]] Occasions& silences() noexcept {
    return all_matters() ? silences_where_all_matters_ : silences_;
  }

  Occasions silences_;
  Occasions silences_where_all_matters_;
  TaskId silent_ = nobody;
  bool counts_changes_ = false;  // otherwise events
  std::uint64_t left_ = 0;       // of what ends the silence
};

}  // namespace ltsim
