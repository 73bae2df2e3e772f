// The decisions of one execution, in their order, and what was tried at each of them: the stack of a depth-first search over
// executions that are run from their begin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ltsim {

/// A set of tasks of one execution: bit = number of a task.
using TaskBits = std::uint64_t;

[[nodiscard]] constexpr TaskBits task_bit(std::size_t task) noexcept { return TaskBits{1} << task; }

struct Decision {
  bool is_of_tasks = false;
  bool is_of_time = false;   ///< 1: time passes; it is tried first
  std::uint32_t chosen = 0;  ///< a task, or a number
  std::uint32_t count = 0;   ///< of numbers; those from chosen on are left (of time: those down to 0)
  std::uint32_t steps = 0;   ///< how many there were before
  TaskBits enabled = 0;
  TaskBits to_try = 0;  ///< all that must be chosen here some time
  TaskBits tried = 0;   ///< and was
  TaskBits asleep = 0;  ///< what they would do next was done before, and nothing since matters to it
};

class DecisionPath {
 public:
  DecisionPath() { decisions_.reserve(decisions_at_first); }

  /// Back to the first decision.
  void begin_execution() noexcept { at_ = 0; }

  /// Whether the next decision is one that no execution has come to.
  [[nodiscard]] bool is_at_end() const noexcept { return at_ == decisions_.size(); }
  /// The next decision: the one that is replayed, or the new one. One that is replayed and is of other tasks or numbers than
  /// before is trouble().
  [[nodiscard]] Decision& next(const Decision& as_new) noexcept;
  /// How many of them this execution has come to.
  [[nodiscard]] std::uint32_t count_so_far() const noexcept { return static_cast<std::uint32_t>(at_); }
  [[nodiscard]] Decision& operator[](std::size_t index) noexcept { return decisions_[index]; }

  /// One that ends before it has come to all of them is trouble().
  void end_execution();
  /// After that: on to the next execution. @return false: that was the last
  [[nodiscard]] bool advance();
  /// Of the next execution: so many of its steps are those of the last one.
  [[nodiscard]] std::uint32_t steps_in_common() const noexcept { return steps_in_common_; }
  /// How much of the search is over, by what is known of it now: 0 to 1.
  [[nodiscard]] double done() const noexcept;
  /// What makes the search impossible, if something does.
  [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }

  /// One line a decision.
  [[nodiscard]] std::string checkpoint() const;
  /// @return whether that was a checkpoint
  [[nodiscard]] bool resume(std::string_view checkpoint);

 private:
  /// More than an execution mostly has: in the middle of one that is told apart by its memory nothing should be allocated.
  static constexpr std::size_t decisions_at_first = 16384;

  void note_that_runs_differ();

  std::vector<Decision> decisions_;
  std::size_t at_ = 0;  // of the next decision
  std::uint32_t steps_in_common_ = 0;
  std::string trouble_;
};

}  // namespace ltsim
