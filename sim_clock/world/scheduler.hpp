// Decides which task runs and when time passes: the hot loop.
//
// One task runs at a time. At each scheduling point the running task asks the strategy and switches straight
// to the chosen task, or goes on without any switch. Nothing here allocates, formats or calls the system per
// scheduling point; tasks, stacks and thread-local storage are pooled from execution to execution.
//
// Invariants
//   I1  exactly one task of a running world runs; it is runnable.
//   I2  a task that is not runnable is blocked on one key, with at most one timer; or stalled, with one
//       timer; or finished.
//   I3  two executions whose strategies choose alike have equal trace hashes.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/check/outcome.hpp"
#include "sim_clock/clock/deadline.hpp"
#include "sim_clock/explore/strategy.hpp"
#include "sim_clock/world/cpu.hpp"
#include "sim_clock/world/step_listener.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;

class Scheduler {
 public:
  /// What one scheduling point costs in virtual time: enough that a loop that polls a clock ends.
  static constexpr SimTime point_cost{100};
  static constexpr std::uint64_t points_max_default = 1'000'000;
  /// So often in a row time may pass for everybody before one step.
  static constexpr unsigned slow_moments_max = 64;
  /// A task that looks at the same thing so often, without changing anything between, waits for others.
  static constexpr std::uint32_t looks_before_giving_way = 16;

  explicit Scheduler(World& world) noexcept : world_(world) {}

  /// Forgets the last execution and prepares the next.
  void reset(Strategy& strategy, StepListener* listener) noexcept;

  // --- set-up, by the scenario ---

  /// The task starts to run when the strategy first chooses it.
  /// @param name  unique within the process
  Task& create_task(ProcessId process, std::string_view name, std::function<void()> body);
  /// Makes room for so many tasks now: processes that are forked from here on need not.
  /// @param count  at most tasks_max
  void pool_tasks(std::size_t count);
  void set_points_max(std::uint64_t points) noexcept {
    points_max_ = points;
    fair_tail_begin_ = points / 2;
  }
  void set_cpu(Cpu cpu) noexcept { cpu_ = cpu; }
  [[nodiscard]] Cpu cpu() const noexcept { return cpu_; }
  /// Called, outside the simulated world, each time that every task waits of its own accord, before time
  /// moves on.
  void add_idle_check(std::function<void()> check) { idle_checks_.push_back(std::move(check)); }
  void add_held_up_note(std::function<void(SimTime)> note) { held_up_notes_.push_back(std::move(note)); }

  /// Runs the tasks until all have finished or the execution has failed. Tasks that have not finished are
  /// dropped where they stand: nothing is unwound.
  void run();
  /// Whether tasks were made and never run.
  [[nodiscard]] bool run_is_missing() const noexcept { return tasks_count_ != 0 && !has_run_; }

  // --- for faults (scheduler_faults.cpp) ---

  /// Asks whether a granted fault strikes: 0, it does not; otherwise 1 to variants_count. Never in the fair tail.
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept;
  /// Stops every task of the process where it stands, for good, without unwinding anything. If the running
  /// task is among them, it runs on until it calls leave_killed().
  void kill_tasks(ProcessId process) noexcept;
  /// No task of the process gets a processor for so long. If the running task is among them, it runs on until it calls
  /// wait_for_processor().
  void stall_process(ProcessId process, SimTime duration) noexcept;
  /// For a running task: somebody else goes on while it is stalled.
  void wait_for_processor() noexcept;
  /// For a running task that was killed: somebody else goes on. Does not return.
  [[noreturn]] void leave_killed() noexcept;
  /// The wall clock was set forward by so much: waits that end by it end so much sooner.
  void wall_clock_was_stepped(SimTime forward) noexcept;
  /// The task, which has not run yet, gets no processor before `begin`.
  void delay_start(Task& task, SimTime begin) noexcept;
  [[nodiscard]] bool has_unfinished_tasks(ProcessId process) const noexcept {
    return unfinished_in_[process] != 0;
  }

  // --- for the running task ---

  /// Scheduling point before `operation`. Returns when the strategy lets this task go on.
  void point(Operation operation) noexcept;
  /// While the running task stood at the point that it passed last. To be asked here: a count of its own that the caller keeps
  /// across the point would be a word of its stack or a register, and would make many states of one (whole_state.hpp).
  [[nodiscard]] bool others_ran() const noexcept { return others_ran_; }

  /// Operation::name of what is called so, for a strategy that follows steps; others are spared the work.
  template <typename Name>
  [[nodiscard]] std::uint8_t name_for_strategy(const Name& name) const noexcept {
    return strategy_follows_steps_ ? name_hash(name()) : std::uint8_t{0};
  }

  /// What the running task performs has turned out to change nothing for anybody.
  void only_looked() noexcept {
    if (strategy_follows_steps_) strategy_->only_looked();
  }

  enum class Wake : std::uint8_t { signalled, timed_out };
  /// Blocks the running task until wake() for `key`, or until `deadline` (VirtualClock::never: no limit).
  Wake block(WaitKey key, Deadline deadline) noexcept;
  /// Wakes up to `count_max` tasks blocked on `key`, longest waiting first.
  /// @return tasks woken
  std::size_t wake(WaitKey key, std::size_t count_max) noexcept;

  /// The running task, of whose body nothing is left to run, ends, with the destructors of its thread-locals and keys.
  [[noreturn]] static void end_running() noexcept;

  /// From now on, in this execution, World::check_step() is told each step.
  void check_steps() noexcept { steps_are_checked_ = true; }
  /// From now on, in this execution, the strategy is not asked whether somebody is slow.
  void set_steady() noexcept { is_steady_ = true; }

  // --- priorities; they matter on Cpu::one_fifo only (one_fifo.cpp) ---

  /// @param priority      1 to 99; 0: none
  /// @param time_sharing  shares the processor with its equals, as SCHED_RR does
  void set_priority(Task& task, int priority, bool time_sharing) noexcept;
  /// `waiter`, about to block, waits for a lock of `owner` that inherits priorities.
  void lend_priority(Task& waiter, Task& owner) noexcept;
  /// What those who wait for `key` have lent goes to the next owner, or (null) to nobody.
  void end_lending(WaitKey key, Task* next_owner) noexcept;
  /// Computes the effective priority anew.
  void update_priority(Task& task) noexcept;

  /// A choice of the scenario: 0 to count - 1.
  [[nodiscard]] std::size_t choose(std::string_view what, std::size_t count) noexcept;

  /// Which store an operation of the running task on weak memory takes. @return index into ages
  [[nodiscard]] std::size_t choose_age(std::span<const std::uint32_t> ages, bool stores) noexcept;

  /// Time was looked at: from now on it matters when it passes.
  void clock_was_read() noexcept { clock_was_read_ = true; }
  /// Whether anybody has looked at time or waited for it in this execution.
  [[nodiscard]] bool time_has_mattered() const noexcept { return clock_was_read_ || clock_.any_armed_ever(); }

  /// By the task itself, as the last that it does: destroys its thread_local objects, the last one that was made first.
  static void destroy_thread_locals(Task& self);

  // --- failing ---

  /// Ends the execution with this outcome; the first one counts. Inside a task it does not return.
  void fail(OutcomeKind kind, std::string message);
  /// The same with a message that is made outside of the task, for what looks at debug information: the library that reads that takes
  /// locks, and for libc a task is no thread.
  /// @param describe  outlives the execution: of what a task has on its stack it holds copies
  void fail_described(OutcomeKind kind, std::function<std::string()> describe);

  /// Ends the execution, which the strategy is not interested in any more. Inside a task it does not return.
  void abandon() noexcept;
  [[nodiscard]] bool is_abandoned() const noexcept { return is_abandoned_; }

  // --- looking ---

  [[nodiscard]] const Outcome& outcome() const noexcept { return outcome_; }
  [[nodiscard]] const VirtualClock& clock() const noexcept { return clock_; }
  [[nodiscard]] std::uint64_t trace_hash() const noexcept { return hash_; }
  [[nodiscard]] std::uint64_t points() const noexcept { return points_; }
  [[nodiscard]] std::uint64_t decisions() const noexcept { return decisions_; }
  [[nodiscard]] std::size_t tasks_count() const noexcept { return tasks_count_; }
  [[nodiscard]] Task& task(TaskId id) noexcept { return *tasks_[id]; }
  [[nodiscard]] const Task& task(TaskId id) const noexcept { return *tasks_[id]; }
  /// The operation at whose scheduling point the task stands or that it last passed.
  [[nodiscard]] const Operation& pending(const Task& task) const noexcept { return pending_[task.id]; }
  [[nodiscard]] StepListener* listener() noexcept { return listener_; }
  /// The task that runs, or ran up to here; null outside run().
  [[nodiscard]] Task* const& running() const noexcept { return running_; }
  /// While tasks run: that of who called run().
  [[nodiscard]] const void* main_stack_pointer() const noexcept { return main_context_.stack_pointer(); }
  /// What of it decides what can follow; the stacks of the tasks are among that.
  void add_state(StateHash& hash) const noexcept;

 private:
  /// The strategy is asked while all tasks stand still; the one that it has chosen finds that the choice fell on it.
  TaskId decide_apart() noexcept;
  void pass_point(Operation operation) noexcept;
  Wake block_running(WaitKey key, Deadline deadline) noexcept;
  static void run_decider(void* scheduler) noexcept;
  // Bytes of a task's stack: most of those that its last life used, and most that one step uses.
  static constexpr std::size_t cleaned_at_begin = std::size_t{16} * 1024;
  static constexpr std::size_t cleaned_at_each_stop = std::size_t{2} * 1024;
  static constexpr std::size_t cleaned_after_each_stop = std::size_t{4} * 1024;
  void set_name(Task& task, ProcessId process, std::string_view name);
  static void run_task(void* task) noexcept;
  static void run_body(Task& self);
  static void run_destructors(Task& self);
  void finish_running() noexcept;
  void describe_failure();
  /// Goes from the running task, which will not run again, to the next, or back to run().
  void leave(Task& self) noexcept;
  /// The next task after the running one stopped being runnable; null when all have finished.
  Task* next_after_stop() noexcept;
  void nobody_can_run() noexcept;
  TaskId choose_task(std::span<const std::uint64_t> options, TaskId running, bool running_gives_way) noexcept;
  void choose_slow_moment() noexcept;
  /// Asks how slow the machine is, and lets time pass for all as long as it is slow.
  /// @return a slow moment of the running task alone that is to follow; duration 0: none
  SlowMoment let_time_pass(bool running_can_be_held_up) noexcept;
  /// Somebody could go on meanwhile.
  void pass_held_up(SimTime duration) noexcept;
  /// Whether the task waits for others, though it can run.
  [[nodiscard]] static bool gives_way(Task& task, Operation operation) noexcept;
  /// An execution that will not end is given a fair end: tasks take turns, nobody is slow, no fault strikes. What does
  /// not end then is a livelock, and not the strategy's doing.
  [[nodiscard]] bool in_fair_tail() const noexcept { return points_ > fair_tail_begin_; }
  /// Those of `options` that one processor would run next, in place.
  std::span<const std::uint64_t> keep_highest_priority(std::span<const std::uint64_t> options) noexcept;
  /// Those that may run next.
  std::span<const std::uint64_t> candidates(TaskId from) noexcept {
    const auto options = runnable_tasks(from);
    return cpu_ == Cpu::many ? options : keep_highest_priority(options);
  }
  /// Runnable tasks in the order of their numbers, from `from` on and then around.
  std::span<const std::uint64_t> runnable_tasks(TaskId from) noexcept {
    if (runnable_count_ > 2 || tasks_count_ > 64) return many_runnable_tasks(from);
    // The most common cases, without loops that end differently each time.
    const std::uint64_t low = static_cast<std::uint64_t>(std::countr_zero(runnable_[0]));
    const std::uint64_t high = 63 - static_cast<std::uint64_t>(std::countl_zero(runnable_[0]));
    // Without branches, too: where tasks are chosen at random, who runs is what no processor foresees, and to be wrong costs as
    // much as half of a scheduling point.
    const bool high_is_first = static_cast<unsigned>(low < from) & static_cast<unsigned>(high >= from);
    const std::uint64_t exchange = (low ^ high) & (0 - std::uint64_t{high_is_first});
    options_[0] = low ^ exchange;
    options_[1] = high ^ exchange;
    return std::span{options_}.first(runnable_count_);
  }
  std::span<const std::uint64_t> many_runnable_tasks(TaskId from) noexcept;
  /// Of two that wait for the same: the longer waiting one; on one processor the one with the higher priority.
  [[nodiscard]] bool goes_before(const Task& one, const Task& other) const noexcept {
    if (cpu_ != Cpu::many && one.effective_priority != other.effective_priority)
      return one.effective_priority > other.effective_priority;
    return one.blocked_since < other.blocked_since;
  }
  void switch_to(Task& next) noexcept;
  void wake_due() noexcept;
  void make_runnable(Task& task) noexcept;
  void make_unrunnable(const Task& task) noexcept;
  /// In the fair tail (fair_tail.cpp): where all who could run wait for others, and somebody sleeps or is held up, that time passes. It
  /// may be longer than the tail, at so much a point.
  void skip_time_if_all_give_way() noexcept;
  /// Notes what the task does in the fair tail, and ends the execution where that has lasted long enough.
  void pass_fair_tail(Task& task, const Operation& operation) noexcept;

  void mix(std::uint64_t word) noexcept { hash_ = std::rotl((hash_ ^ word) * 0x9e3779b97f4a7c15U, 27); }

  World& world_;
  Strategy* strategy_ = nullptr;
  StepListener* listener_ = nullptr;
  Task* running_ = nullptr;
  Context main_context_;
  Context decider_context_;
  std::unique_ptr<TaskStorage> decider_storage_;  // once it is needed
  VirtualClock clock_;

  std::array<std::uint64_t, tasks_max / 64> runnable_{};   // bit = task number
  std::array<std::uint64_t, tasks_max / 64> under_way_{};  // those that block() has not returned to
  std::size_t runnable_count_ = 0;
  std::size_t stalled_count_ = 0;
  std::array<std::uint64_t, tasks_max> options_{};
  std::array<Operation, tasks_max> pending_{};  // by task number
  /// What a strategy is asked; kept, because most of it is the same each time.
  TaskChoice choice_{
      .options = {}, .running = 0, .running_gives_way = false, .pending = pending_, .under_way = under_way_};
  std::vector<std::unique_ptr<Task>> tasks_;  // pooled; the first tasks_count_ belong to this execution
  std::size_t tasks_count_ = 0;
  std::size_t unfinished_count_ = 0;
  std::array<std::uint16_t, processes_max> unfinished_in_{};  // by process
  std::array<SimTime, processes_max> no_processor_before_{};  // by process

  std::uint64_t points_ = 0;
  std::uint64_t points_max_ = points_max_default;
  std::uint64_t fair_tail_begin_ = points_max_default / 2;
  std::uint64_t decisions_ = 0;
  std::uint64_t blocked_ever_ = 0;
  std::uint64_t hash_ = 0;
  bool clock_was_read_ = false;
  bool has_run_ = false;
  bool strategy_follows_steps_ = false;
  bool decides_apart_ = false;
  // Since the running task came to the point where it stands or that it passed last.
  bool others_ran_ = false;
  SimTime point_cost_{point_cost};
  Cpu cpu_ = Cpu::many;
  std::uint64_t ready_ever_ = 0;
  bool steps_are_checked_ = false;
  bool is_steady_ = false;
  bool passes_uncontended_ = false;  // the strategy: in this execution
  bool is_abandoned_ = false;
  Outcome outcome_;
  std::function<std::string()> describe_outcome_;  // until its message is made
  std::vector<std::function<void()>> idle_checks_;
  std::vector<std::function<void(SimTime)>> held_up_notes_;
};

}  // namespace ltsim
