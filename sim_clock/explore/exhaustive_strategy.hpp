// All executions of a scenario, one after the other: a depth-first search over its choices that runs each execution from its
// begin.
//
// Reduction. Executions that differ only in the order of steps whose order cannot matter (dependence.hpp) are one Mazurkiewicz
// trace; one of them is run. By source sets with sleep sets (Abdulla, Aronis, Jonsson, Sagonas: Optimal Dynamic Partial Order
// Reduction, POPL 2014): where two steps race, the other order is tried where the first of them was chosen. What is
// found to be a trace that was seen already is left at once, and counted as redundant. Who would wait for a mutex or a
// semaphore, and without a time-out, is not chosen before he can have it.
//
// Time stands while anybody can run: scheduling points cost none here.
//
// With a bound on preemptions, which the orders of one trace do not share, there is no reduction: all schedules within it are run.
// Then time may also pass although somebody can run, in so many silences (ProofBounds::silences).
//
// Where states are told apart (ProofBounds::states), an execution is left in a state that was seen. Sleep sets leave out ways into a
// state as well; what was asleep in it each time that it was come to has not been tried there (Godefroid: Partial-Order Methods for
// the Verification of Concurrent Systems, 1996, 5.4).
//
// Besides the order of tasks and time the choices are: faults, as often as the scenario grants them; what the scenario asks; and
// which store a load of a weak memory sees.
//
// A task that has polled in vain waits until another one has changed something (ProofBounds::looks). Executions of more than
// steps_max steps are counted as cut off.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/explore/decision_path.hpp"
#include "sim_clock/explore/seen_states.hpp"
#include "sim_clock/explore/step_races.hpp"
#include "sim_clock/explore/strategy.hpp"

namespace ltsim {

class World;

/// What a proof covers, besides the faults that the scenario grants.
struct ProofBounds {
  std::optional<unsigned> preemptions{};  ///< of tasks that could have gone on; none: any number
  /// Stretches in which time goes on, from timer to timer, while some task that could run takes no step; none: any number. One may
  /// end after its first timer, and wherever somebody has done more than look (and sleep) since the last: a task that looks in vain
  /// again and again, and at a clock, does so until its time is over. Only with a bound on preemptions, or with `states`.
  std::optional<unsigned> silences{0};
  /// In vain, at the same thing, until a polling task waits for a change; not with `states`.
  unsigned looks = 4;
  /// States are told apart, and one that was seen is left, instead of a reduction.
  bool states = false;
};

class ExhaustiveStrategy final : public Strategy {
 public:
  static constexpr std::size_t tasks_max = search_tasks_max;
  /// Of one execution; all that comes after them is by default.
  static constexpr std::size_t steps_max = 4096;

  /// @param world  whose scenario it explores; outlives this
  ExhaustiveStrategy(World& world, ProofBounds bounds);

  /// After an execution: on to the next one. @return false: that was the last, or there is trouble()
  [[nodiscard]] bool advance();

  /// The last execution came to nothing new, and was left.
  [[nodiscard]] bool was_redundant() const noexcept { return is_redundant_; }
  /// The last execution was longer than steps_max.
  [[nodiscard]] bool was_cut_off() const noexcept { return is_cut_off_; }
  /// In the last execution a task that polled could have gone on, and was made to wait.
  [[nodiscard]] bool was_held_back() const noexcept { return is_held_back_; }
  /// What makes the search impossible, if something does.
  [[nodiscard]] const std::string& trouble() const noexcept {
    return trouble_.empty() ? path_.trouble() : trouble_;
  }
  /// How many states were told apart (ProofBounds::states).
  [[nodiscard]] std::uint64_t states() const noexcept { return states_.size(); }

  /// From here on the search is of this part. States that were told apart before stay so.
  void begin_item(const SearchItem& item) { path_.begin_item(item); }
  /// Where the search of the part stands: its decisions that are not settled.
  [[nodiscard]] std::span<const Decision> rest() const noexcept { return path_.rest(); }
  /// What must be tried at those that are.
  [[nodiscard]] const std::vector<TreeRequest>& requests() const noexcept { return path_.requests(); }

  [[nodiscard]] std::string_view name() const noexcept override { return "exhaustive"; }
  void begin_execution(std::uint64_t seed) noexcept override;
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  void only_one_can_run(TaskId task) noexcept override;
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept override;
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept override;
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept override;
  [[nodiscard]] std::size_t choose_age(const AgeChoice& choice) noexcept override;
  [[nodiscard]] bool points_cost_time() const noexcept override { return false; }
  [[nodiscard]] bool looks_at_states() const noexcept override { return bounds_.states; }
  [[nodiscard]] bool follows_steps() const noexcept override { return true; }
  void performs(TaskId task, const Operation& operation) noexcept override;
  void resumes(TaskId task, const Operation& operation) noexcept override;
  void only_looked() noexcept override;

 private:
  static constexpr std::size_t steppers_count = tasks_max + 1;  // the_barrier is one

  /// Bounds on preemptions and on silences are nothing that the orders of one trace share.
  [[nodiscard]] bool puts_to_sleep() const noexcept {
    return !bounds_.preemptions && (!bounds_.silences || *bounds_.silences == 0);
  }
  /// Where states are told apart, all that can be done in each of them is tried.
  [[nodiscard]] bool is_reduced() const noexcept { return puts_to_sleep() && !bounds_.states; }
  /// Whether there have been steps_max, which counts as cut off.
  [[nodiscard]] bool is_too_long() noexcept {
    is_cut_off_ = is_cut_off_ || steps_.size() >= steps_max;
    return is_cut_off_;
  }
  /// The next decision: the one that is replayed, or a new one.
  [[nodiscard]] Decision& next_decision(Decision as_new) noexcept;
  [[nodiscard]] std::uint32_t decide_number(std::size_t count) noexcept;
  /// Ends the execution: it is redundant, or the search cannot go on.
  void leave() noexcept;
  std::size_t leave_as_redundant() noexcept;
  /// Those who wait race with who took what they wait for: they might have come first.
  void add_waits(TaskBits waiting) noexcept;
  /// Comes to a state in which all are to be tried that can go on, but those that are asleep.
  /// @param runner  who could be preempted; or the_barrier
  /// @return        those that were tried in it before
  [[nodiscard]] TaskBits visit_state(std::size_t runner, TaskBits asleep) noexcept;
  void begin_step(std::size_t stepper, const Operation& operation, bool is_resumed) noexcept;
  void add_barrier(bool is_time) noexcept;
  /// What happened since the last step besides it: who was woken, by whom or by time that passed by itself.
  void look_around() noexcept;
  void wake_sleepers(const Step& step) noexcept;
  /// What is taken by those who lock and wait: whether one could.
  [[nodiscard]] bool is_free(const Operation& operation) const noexcept;
  /// Those who could take a step now.
  [[nodiscard]] TaskBits able() const noexcept;
  /// Whether it is too late to end the silence, as somebody looks in vain again.
  [[nodiscard]] bool silence_goes_on() const noexcept { return silent_ != 0 && silence_steps_ > 1; }
  /// Whether the task, which can run, would only begin to wait. It is left where it stands then: that makes no difference to
  /// anybody, and one order less.
  [[nodiscard]] bool would_wait(std::size_t task) const noexcept;
  [[nodiscard]] StepEffect pending_of(std::size_t task) const noexcept;

  World& world_;
  ProofBounds bounds_;
  std::string trouble_;
  DecisionPath path_;
  StepRaces steps_;
  SeenStates states_;
  TaskBits asleep_ = 0;
  TaskBits polling_ = 0;
  unsigned preemptions_ = 0;
  unsigned silences_ = 0;        // so far
  bool clock_was_used_ = false;  // since the last timer of a silence
  unsigned silence_steps_ = 0;   // of the last one, since somebody has done more than look
  TaskBits silent_ = 0;          // who has been so all through it
  TaskBits blocked_ = 0;
  TaskBits awaits_join_ = 0;
  TaskBits joined_ = 0;
  std::vector<std::uint32_t> woken_by_;  // by task
  std::vector<std::uint32_t> follows_;   // by task: for its next step
  bool is_redundant_ = false;
  bool is_cut_off_ = false;
  bool is_held_back_ = false;
};

}  // namespace ltsim
