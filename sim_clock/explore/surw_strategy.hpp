// Selectively uniform random walk: the interleavings of the operations on one shared thing, drawn anew for each
// execution, are sampled uniformly; everything else runs at random around them.
//
// Source: Zhao, Wolff, Mathur, Roychoudhury, "Selectively uniform concurrency testing", ASPLOS 2025. If the
// task that is to do the next interesting operation is drawn with a probability proportional to the number of
// interesting operations that it has left, all their interleavings are equally likely. The others wait before
// their interesting operations until that task has done its own; one that had to wait within its operation, and
// can go on, has done it. The numbers are learned from the executions before. Interesting is one thing (SharedThings) that several tasks use, or, where all matters,
// everything. In every second execution the clock takes part as a task with 1 to 64 operations, each of which
// goes on to the next timer.
#pragma once

#include <array>

#include "sim_clock/explore/sampling_strategy.hpp"

namespace ltsim {

class SurwStrategy final : public SamplingStrategy {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "surw"; }
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  void learn(const ExecutionSummary& summary) noexcept override;
  [[nodiscard]] bool follows_steps() const noexcept override { return true; }
  void performs(TaskId task, const Operation& operation) noexcept override;

 private:
  static constexpr std::size_t everything = SharedThings::things_max;
  static constexpr TaskId nobody = VirtualClock::no_task;
  static constexpr TaskId the_clock = nobody - 1;

  using Counts = std::array<std::uint32_t, tasks_max>;  // by task number

  TimeMode begin() noexcept override;
  [[nodiscard]] bool clock_goes_first(const SlowMomentChoice& choice) noexcept override;
  [[nodiscard]] std::size_t draw_interesting() noexcept;
  [[nodiscard]] TaskId draw_next() noexcept;
  /// All who can run wait for one who cannot, or for the clock without a timer: one of them, in proportion to what
  /// they have left.
  [[nodiscard]] std::size_t draw_waiting(const TaskChoice& choice) noexcept;
  [[nodiscard]] bool is_interesting(const Operation& operation) noexcept;

  std::size_t tasks_seen_ = 0;     // all have smaller numbers
  std::size_t tasks_learned_ = 0;  // of executions that count: one that is run again begins with no more
  std::array<Counts, everything + 1> passed_{};    // in this execution; the last: of everything
  std::array<Counts, everything + 1> expected_{};  // in an execution
  Counts left_{};                                  // of interesting operations
  std::uint64_t clock_left_ = 0;  // firings of timers that count as interesting operations of the clock
  std::uint64_t left_sum_ = 0;    // the clock's included
  std::size_t interesting_ = everything;
  TaskId next_ = nobody;  // does the next interesting operation
};

}  // namespace ltsim
