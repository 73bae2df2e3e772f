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
// Besides the order of tasks and time the choices are: faults, as often as the scenario grants them; what the scenario asks; and
// which store a load of a weak memory sees.
//
// A task that has polled in vain waits until another one has changed something (ProofBounds::looks). Executions of more than
// steps_max steps are counted as cut off.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/explore/dependence.hpp"
#include "sim_clock/explore/strategy.hpp"

namespace ltsim {

class World;

/// What a proof covers, besides the faults that the scenario grants.
struct ProofBounds {
  std::optional<unsigned> preemptions;  ///< of tasks that could have gone on; none: any number
  /// Only with a bound on preemptions. Stretches in which time goes on, from timer to timer, while some task that could run
  /// takes no step. One may end after its first timer, and wherever somebody has done more than look (and sleep) since the
  /// last: a task that looks in vain again and again, and at a clock, does so until its time is over.
  unsigned silences = 0;
  unsigned looks = 4;  ///< in vain, at the same thing, until a polling task waits for a change
};

class ExhaustiveStrategy final : public Strategy {
 public:
  static constexpr std::size_t tasks_max = 60;
  /// Of one execution; all that comes after them is by default.
  static constexpr std::size_t steps_max = 4096;

  /// @param world  whose scenario it explores; outlives this
  ExhaustiveStrategy(World& world, ProofBounds bounds) : world_(world), bounds_(bounds) {}

  /// After an execution: on to the next one. @return false: that was the last, or there is trouble()
  [[nodiscard]] bool advance();

  /// The last execution came to nothing new, and was left.
  [[nodiscard]] bool was_redundant() const noexcept { return is_redundant_; }
  /// The last execution was longer than steps_max.
  [[nodiscard]] bool was_cut_off() const noexcept { return is_cut_off_; }
  /// In the last execution a task that polled could have gone on, and was made to wait.
  [[nodiscard]] bool was_held_back() const noexcept { return is_held_back_; }
  /// How much of the search is over, by what is known of it now: 0 to 1. More may turn up.
  [[nodiscard]] double done() const noexcept;
  /// What makes the search impossible, if something does.
  [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }

  /// The search where it stands, one line a choice.
  [[nodiscard]] std::string checkpoint() const;
  /// @return whether that was a checkpoint
  [[nodiscard]] bool resume(std::string_view checkpoint);

  [[nodiscard]] std::string_view name() const noexcept override { return "exhaustive"; }
  void begin_execution(std::uint64_t seed) noexcept override;
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept override;
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept override;
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept override;
  [[nodiscard]] std::size_t choose_age(const AgeChoice& choice) noexcept override;
  [[nodiscard]] bool points_cost_time() const noexcept override { return false; }
  [[nodiscard]] bool follows_steps() const noexcept override { return true; }
  void performs(TaskId task, const Operation& operation) noexcept override;
  void resumes(TaskId task, const Operation& operation) noexcept override;
  void only_looked() noexcept override;

 private:
  using Tasks = std::uint64_t;  // bit = number of a task
  // Besides tasks, faults take steps, and time that passes when nobody can run.
  static constexpr std::size_t the_barrier = tasks_max;
  static constexpr std::size_t steppers_count = tasks_max + 1;
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  [[nodiscard]] static constexpr Tasks bit(std::size_t task) noexcept { return Tasks{1} << task; }

  struct Decision {
    bool is_of_tasks = false;
    bool is_of_time = false;   // 1: time passes; it is tried first
    std::uint32_t chosen = 0;  // a task, or a number
    std::uint32_t count = 0;   // of numbers; those from chosen on are left (of time: those down to 0)
    std::uint32_t events = 0;  // how many there were before
    Tasks enabled = 0;
    Tasks to_try = 0;  // all that must be chosen here some time
    Tasks tried = 0;   // and was
    Tasks asleep = 0;  // what they would do next was done before, and nothing since matters to it
  };
  struct Event {
    std::size_t stepper = 0;
    StepEffect effect;
    std::uint32_t decisions = 0;    // how many there were before it
    std::uint32_t woken_by = none;  // a step that is gone on with: the event that made that possible
    // An event that comes before it: it made the task, or was the last of one that is joined.
    std::uint32_t follows = none;
    bool is_time = false;  // that passes; it has to come here
    bool was_free = true;  // what it acts on, before, for those who take it: a mutex, a token of a semaphore
  };

  /// Whether there have been steps_max, which counts as cut off.
  [[nodiscard]] bool is_too_long() noexcept {
    is_cut_off_ = is_cut_off_ || events_.size() >= steps_max;
    return is_cut_off_;
  }
  /// The next decision: the one that is replayed, or a new one.
  [[nodiscard]] Decision& next_decision(const Decision& as_new) noexcept;
  [[nodiscard]] std::uint32_t decide_number(std::size_t count) noexcept;
  void note_that_runs_differ();
  /// Ends the execution: it is redundant, or the search cannot go on.
  void leave() noexcept;
  void begin_event(std::size_t stepper, const Operation& operation, bool is_resumed) noexcept;
  void add_barrier(bool is_time) noexcept;
  /// What happened since the last event besides it: who was woken, by whom or by time that passed by itself.
  void look_around() noexcept;
  void wake_sleepers(const Event& event) noexcept;
  [[nodiscard]] bool depend(const Event& one, const Event& other) const noexcept;
  /// What is taken by those who lock and wait: whether one could.
  [[nodiscard]] bool is_free(const Operation& operation) const noexcept;
  /// Those who could take a step now.
  [[nodiscard]] Tasks able() const noexcept;
  /// Whether it is too late to end the silence, as somebody looks in vain again.
  [[nodiscard]] bool silence_goes_on() const noexcept { return silent_ != 0 && silence_steps_ > 1; }
  /// Whether the task, which can run, would only begin to wait. It is left where it stands then: that makes no difference to
  /// anybody, and one order less.
  [[nodiscard]] bool would_wait(std::size_t task) const noexcept;
  [[nodiscard]] StepEffect pending_of(std::size_t task) const noexcept;

  /// Finds the races of the events from `replayed_events_` on, and adds what must be tried because of them.
  void find_races();
  /// Sees to it that `later` comes before `earlier`, too. @return whether that can be
  bool reverse(std::uint32_t earlier, std::uint32_t later);
  [[nodiscard]] std::uint32_t* clock_of(std::size_t event) noexcept {
    return clocks_.data() + event * steppers_count;
  }
  [[nodiscard]] bool happens_before(std::size_t earlier, std::size_t later) noexcept {
    return clock_of(later)[events_[earlier].stepper] > earlier;
  }

  World& world_;
  ProofBounds bounds_;
  std::string trouble_;
  std::vector<Decision> path_;
  std::size_t at_ = 0;  // in path_, of the next decision
  std::uint32_t replayed_events_ = 0;
  Tasks asleep_ = 0;
  Tasks polling_ = 0;
  unsigned preemptions_ = 0;
  unsigned silences_ = 0;        // so far
  bool clock_was_used_ = false;  // since the last timer of a silence
  unsigned silence_steps_ = 0;   // of the last one, since somebody has done more than look
  Tasks silent_ = 0;             // who has been so all through it
  Tasks blocked_ = 0;
  Tasks awaits_join_ = 0;
  Tasks joined_ = 0;
  std::vector<Event> events_;
  // By event: per stepper, one more than its last event that happens before.
  std::vector<std::uint32_t> clocks_;
  std::vector<std::uint32_t> but_for_fixed_;  // a clock that is being made
  std::vector<std::uint32_t> last_of_;        // by stepper: its last event
  std::vector<std::uint32_t> woken_by_;       // by task
  std::vector<std::uint32_t> follows_;        // by task: for its next event
  bool is_redundant_ = false;
  bool is_cut_off_ = false;
  bool is_held_back_ = false;
};

}  // namespace ltsim
