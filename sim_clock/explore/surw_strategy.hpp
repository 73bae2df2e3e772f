// Selectively uniform random walk: the interleavings of the operations on one shared thing, drawn anew for each
// execution, are sampled uniformly; everything else runs at random around them.
//
// Source: Zhao, Wolff, Mathur, Roychoudhury, "Selectively uniform concurrency testing", ASPLOS 2025. If the
// task that is to do the next interesting operation is drawn with a probability proportional to the number of
// interesting operations that it has left, all their interleavings are equally likely. The others wait before
// their interesting operations until that task has done its own. The numbers are learned from the executions
// before. Interesting is one thing (a semaphore, a mutex, a word of a segment, all atomics outside of
// segments) that two tasks use, or, in one execution of four, everything.
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
  /// Shared things that are told apart; those beyond count as the last.
  static constexpr std::size_t things_max = 32;
  static constexpr std::size_t everything = things_max;
  static constexpr TaskId nobody = VirtualClock::no_task;

  using Counts = std::array<std::uint32_t, tasks_max>;  // by task number

  TimeMode begin() noexcept override;
  [[nodiscard]] std::size_t draw_interesting() noexcept;
  [[nodiscard]] TaskId draw_next() noexcept;
  /// Which thing the operation acts on, from 0; `everything` if on none.
  [[nodiscard]] std::size_t thing_of(const Operation& operation) noexcept;
  [[nodiscard]] bool is_interesting(const Operation& operation) noexcept;

  std::array<std::uint64_t, things_max> keys_{};
  std::size_t things_count_ = 0;
  std::size_t tasks_seen_ = 0;  // all have smaller numbers
  // Of both, those of executions that count: one that is run again begins with no more.
  std::size_t things_learned_count_ = 0;
  std::size_t tasks_learned_ = 0;
  std::array<Counts, things_max + 1> passed_{};    // in this execution; the last: of everything
  std::array<Counts, things_max + 1> expected_{};  // in an execution
  Counts left_{};                                  // of interesting operations
  std::uint64_t left_sum_ = 0;
  std::size_t interesting_ = everything;
  TaskId next_ = nobody;  // does the next interesting operation
};

}  // namespace ltsim
