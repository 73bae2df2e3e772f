// The decisions of one execution, in their order, and what was tried at each of them: the stack of a depth-first search over
// executions that are run from their begin.
//
// A search can be of a part only: the first decisions are settled then. They stay as they are; what turns out to have to be tried
// there as well is asked for (TreeRequest), for whoever has the whole (search_tree.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ltsim {

/// A set of tasks of one execution: bit = number of a task.
using TaskBits = std::uint64_t;

inline constexpr std::size_t search_tasks_max = 60;

[[nodiscard]] constexpr TaskBits task_bit(std::size_t task) noexcept { return TaskBits{1} << task; }

struct Decision {
  bool is_of_tasks = false;
  bool is_of_time = false;   ///< 1: time passes; it is tried first
  std::uint32_t chosen = 0;  ///< a task, or a number
  std::uint32_t count = 0;   ///< of numbers; those from chosen on are left (of time: those down to 0)
  std::uint32_t steps = 0;   ///< how many there were before
  TaskBits enabled = 0;
  TaskBits to_try = 0;  ///< all that must be chosen here some time; add to it by must_try()
  TaskBits tried = 0;   ///< and was
  TaskBits asleep = 0;  ///< what they would do next was done before, and nothing since matters to it
  /// Those of to_try, in the order in which they were found to have to be tried. They are tried in that order: what is asleep for
  /// one of them is known at once, whatever is found later.
  std::array<std::uint8_t, search_tasks_max> order{};

  void must_try(std::size_t task) noexcept;
  /// Sees to it that one of `any` is chosen here some time. @return false: none of them can be
  bool must_try_one_of(TaskBits any) noexcept;
  /// Whether that needs something new.
  [[nodiscard]] bool has_one_of(TaskBits any) const noexcept { return (any & (to_try | asleep)) != 0; }

  [[nodiscard]] bool has_next() const noexcept;
  /// Chooses what comes next. @return false: nothing is left
  bool advance() noexcept;
  /// How many there are to be chosen, by what is known now, and how many were before the one that is.
  [[nodiscard]] unsigned alternatives() const noexcept;
  [[nodiscard]] unsigned alternatives_before() const noexcept;

 private:
  /// Of tasks.
  [[nodiscard]] std::optional<std::uint32_t> next_task() const noexcept;
};

/// One line, without its end.
[[nodiscard]] std::string to_string(const Decision& decision);
[[nodiscard]] std::optional<Decision> parse_decision(const std::string& line);

/// One of these tasks must be chosen at a settled decision, too.
struct TreeRequest {
  std::uint32_t decision = 0;
  TaskBits any = 0;
};

/// Adds the request unless an earlier one comes to the same.
void add_request(std::vector<TreeRequest>& requests, TreeRequest request);

/// A part of a search: all executions that begin with the settled decisions, from where the others stand.
struct SearchItem {
  std::vector<Decision> decisions;
  std::size_t settled = 0;  ///< so many, from the first
};

/// How much of the decisions' search is over: 0 to 1.
[[nodiscard]] double done_of(std::span<const Decision> decisions) noexcept;

class DecisionPath {
 public:
  DecisionPath() { decisions_.reserve(decisions_at_first); }

  void begin_item(const SearchItem& item);
  /// Back to the first decision.
  void begin_execution() noexcept { at_ = 0; }

  /// Whether the next decision is one that no execution has come to.
  [[nodiscard]] bool is_at_end() const noexcept { return at_ == decisions_.size(); }
  /// The next decision: the one that is replayed, or the new one. One that is replayed and is of other tasks or numbers than
  /// before is trouble().
  [[nodiscard]] Decision& next(const Decision& as_new) noexcept;
  /// How many of them this execution has come to.
  [[nodiscard]] std::uint32_t count_so_far() const noexcept { return static_cast<std::uint32_t>(at_); }

  /// Sees to it that one of the tasks is chosen there some time, here or by whoever has the whole.
  /// @return false: none of them can be
  bool must_try_one_of(std::size_t decision, TaskBits any);

  /// One that ends before it has come to all of them is trouble().
  void end_execution();
  /// After that: on to the next execution. @return false: that was the last
  [[nodiscard]] bool advance();
  /// Of the next execution: so many of its steps are those of the last one.
  [[nodiscard]] std::uint32_t steps_in_common() const noexcept { return steps_in_common_; }
  /// What makes the search impossible, if something does.
  [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }

  /// All that are not settled.
  [[nodiscard]] std::span<const Decision> rest() const noexcept {
    return std::span{decisions_}.subspan(std::min(settled_, decisions_.size()));
  }
  /// In their order.
  [[nodiscard]] const std::vector<TreeRequest>& requests() const noexcept { return requests_; }

 private:
  /// More than an execution mostly has: in the middle of one that is told apart by its memory nothing should be allocated.
  static constexpr std::size_t decisions_at_first = 16384;

  void note_that_runs_differ();

  std::vector<Decision> decisions_;
  std::vector<TreeRequest> requests_;
  std::size_t settled_ = 0;
  std::size_t at_ = 0;  // of the next decision
  std::uint32_t steps_in_common_ = 0;
  std::string trouble_;
};

}  // namespace ltsim
