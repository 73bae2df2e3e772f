// Probabilistic concurrency testing: tasks have random priorities, the highest that can run runs; at d - 1
// points, drawn uniformly from the execution's length, the running task falls below all others.
//
// Source: Burckhardt, Kothari, Musuvathi, Nagarakatte, "A randomized scheduler with probabilistic guarantees of
// finding bugs", ASPLOS 2010: with n tasks and k points a bug of depth d is found with probability at least
// 1/(n k^(d-1)). k is estimated from the executions before; d is drawn for each execution from 1 to 6, small
// ones more often. In three executions of four priorities change only before operations on things that several
// tasks use (SharedThings). The clock is one of the tasks: a time-out fires early when the clock has a higher priority
// than all who could run, at most 1, 2, 4 ... 128 times in an execution, and a falling task falls below the clock,
// too. A task that yields or polls falls, as its source does with one that yields: what it waits for would never
// come.
//
// Known limit: a task falls behind a step of its own, where the source lets it fall before one. So one that has not taken a step
// yet stays above all that have fallen: of three tasks, "2 1 2 0" is never seen. The other strategies, and so the default, see it.
#pragma once

#include <array>

#include "sim_clock/explore/sampling_strategy.hpp"

namespace ltsim {

class PctStrategy final : public SamplingStrategy {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "pct"; }
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  void learn(const ExecutionSummary& summary) noexcept override;
  [[nodiscard]] bool follows_steps() const noexcept override { return true; }
  void performs(TaskId task, const Operation& operation) noexcept override;

 private:
  TimeMode begin() noexcept override;
  [[nodiscard]] bool clock_goes_first(const SlowMomentChoice& choice) noexcept override;

  [[nodiscard]] std::uint64_t priority_of(std::size_t task) noexcept;
  void lower(std::size_t task) noexcept;

  static constexpr std::size_t clock = tasks_max;  // its place among the priorities

  [[nodiscard]] Occasions& change_points() noexcept {
    return all_matters() ? change_points_where_all_matters_ : change_points_;
  }

  Occasions change_points_;
  Occasions change_points_where_all_matters_;
  std::array<std::uint64_t, tasks_max + 1> priorities_{};  // 0: none drawn yet
  std::uint64_t next_lower_ =
      0;  // those who have fallen have priorities below all drawn ones, the last the lowest
};

}  // namespace ltsim
