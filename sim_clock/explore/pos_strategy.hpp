// Partial order sampling: each pending operation has a random priority, the highest that can run runs; when it
// has run, the operations that it conflicts with draw anew.
//
// Source: Yuan, Yang, Gu, "Partial order aware concurrency sampling", CAV 2018. Operations that nothing depends
// on are not drawn again and again, so the sample is close to uniform over partial orders rather than over
// interleavings. The clock takes part with an operation of its own, "to the next timer": one that meets a low
// priority elsewhere passes it many times in a row, which is how a peer is slow for several time-outs. Reading
// a clock conflicts with nothing and runs at once; so does going to sleep, in every second execution. Looking a
// fourth time at what nobody has changed draws no new priority, so that a task that polls is as slow or as quick
// as if it looked once more; one that yields or polls without end has the lowest priority.
#pragma once

#include <array>
#include <limits>

#include "sim_clock/explore/sampling_strategy.hpp"

namespace ltsim {

class PosStrategy final : public SamplingStrategy {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "pos"; }
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  [[nodiscard]] bool follows_steps() const noexcept override { return true; }
  void performs(TaskId task, const Operation& operation) noexcept override;

 private:
  TimeMode begin() noexcept override;
  [[nodiscard]] bool clock_goes_first(const SlowMomentChoice& choice) noexcept override;

  [[nodiscard]] std::uint64_t priority_of(std::size_t task) noexcept;

  /// What a task has looked at last.
  struct Look {
    Operation operation;
    std::uint64_t priority = 0;
    std::uint32_t count = 0;  // in a row; 0: somebody has changed it since
  };

  static constexpr std::size_t clock = tasks_max;  // its place among the priorities
  static constexpr std::uint64_t lowest = 1;
  static constexpr std::uint64_t highest = std::numeric_limits<std::uint64_t>::max();

  std::array<std::uint64_t, tasks_max + 1> priorities_{};  // of the pending operation; 0: none drawn yet
  std::array<Look, tasks_max> looks_{};                    // by task
  bool sleeps_are_free_ = false;
  std::size_t tasks_seen_ = 0;  // all have smaller numbers
  std::span<const Operation> pending_;
};

}  // namespace ltsim
