// A strategy makes the choices of an execution; strategies differ in nothing else.
//
// Every nondeterminism of a world is a choice on one stream: which task runs, how much time passes although
// somebody could run, whether a fault strikes, what a scenario asks for, which store a load of a weak memory sees. Each has
// a default (the first task; no time passes; no fault; 0; the latest), so that a schedule can be told as the few choices that deviate from it.
//
// The choices of an execution follow from its seed and from what the strategy has learned in the executions
// before it (learn()), and from nothing else: two explorations with equal seeds make equal choices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "sim_clock/clock/virtual_clock.hpp"
#include "sim_clock/world/fault_kind.hpp"
#include "sim_clock/world/operation.hpp"

namespace ltsim {

/// Which task runs next.
struct TaskChoice {
  std::span<const std::uint64_t> options;  ///< at least two task numbers, the default first
  TaskId running = 0;                      ///< the task that ran up to here; it need not be among the options
  /// The running task waits for others: it yields, or polls and finds the same again and again. A strategy
  /// that goes on with it for long will never see what it waits for.
  bool running_gives_way = false;
  std::span<const Operation> pending;  ///< by task number: what each will do next
  /// One bit a task, 64 to a word: its pending operation has begun. It had to wait in it, and goes on from there.
  std::span<const std::uint64_t> under_way;
};

/// Time that passes although somebody could run.
struct SlowMoment {
  SimTime duration{0};  ///< >= 0; 0: nothing happens
  bool others_go_on =
      false;  ///< only the task at whose step it happens gets no processor; otherwise none does
};

/// What there is to know where time may pass.
struct SlowMomentChoice {
  SimTime until_next_timer = VirtualClock::never;  ///< >= 0; `never` when no timer is armed
  TaskId running = 0;                              ///< the task that ran up to here
  /// Whether it is about to take a step, and others_go_on is a possible answer; otherwise it has just stopped
  /// being able to run, and only time for all may pass.
  bool running_can_be_held_up = true;
  std::span<const std::uint64_t> runnable;   ///< one bit a task, 64 to a word; never empty
  std::span<const Operation> pending;        ///< by task number: what each will do next
  std::span<const std::uint64_t> under_way;  ///< as in TaskChoice
};

/// Which of the stores that a weak memory keeps of one place a load sees, or right after which of them a store takes its
/// place (Memory::c11 only).
struct AgeChoice {
  /// How many stores of the place are newer, by option: at least two, ascending, the first 0.
  std::span<const std::uint32_t> ages;
  bool stores = false;  ///< it is a store, which sees nothing
  TaskId running = 0;   ///< whose operation it is
};

/// What an execution was like, for strategies that learn.
struct ExecutionSummary {
  std::uint64_t points = 0;      ///< scheduling points passed
  std::uint64_t new_states = 0;  ///< abstract states and reads-from pairs that no execution before it showed
  bool failed_anew = false;      ///< in a way that no execution before it did
};

class Strategy {
 public:
  virtual ~Strategy() = default;

  /// In memory that is shared with forked processes (StartState::fork): what a strategy learns of an execution there is learned here. So
  /// one that learns keeps what it has learned within itself, in no container that has memory elsewhere.
  static void* operator new(std::size_t bytes);
  static void operator delete(void* strategy, std::size_t bytes) noexcept;

  [[nodiscard]] virtual std::string_view name() const noexcept = 0;

  /// Called before the first choice of an execution. Without learn() in between, the same seed means the same
  /// choices.
  virtual void begin_execution(std::uint64_t seed) noexcept = 0;

  /// The execution begun last has ended and counts. Not called for one that is run again to write it down.
  virtual void learn(const ExecutionSummary& /*summary*/) noexcept {}

  /// @return  index into choice.options
  [[nodiscard]] virtual std::size_t choose_task(const TaskChoice& choice) noexcept = 0;

  /// Whether the task that is about to take a step is held up first: its processor, or the whole machine, is
  /// slow. So a time-out may fire whose peer is merely late. Also asked where a task has stopped being able to
  /// run, and others can. Only asked while time matters to somebody, and asked again after the whole machine was
  /// slow, until it is not.
  /// @return  the default is no slow moment
  [[nodiscard]] virtual SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept = 0;

  /// Whether a fault that the scenario has granted strikes here. Not asked for a kind that is not granted or
  /// used up.
  /// @param variants_count  >= 1: in how many ways this kind can strike here
  /// @return                0: it does not; otherwise 1 to variants_count
  [[nodiscard]] virtual std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept = 0;

  /// A question of the scenario, World::choose().
  /// @param count  >= 2
  /// @return       0 to count - 1
  [[nodiscard]] virtual std::size_t answer(std::size_t count) noexcept = 0;

  /// @return  index into choice.ages
  [[nodiscard]] virtual std::size_t choose_age(const AgeChoice& choice) noexcept = 0;

  /// Whether scheduling points take virtual time. Asked once an execution.
  [[nodiscard]] virtual bool points_cost_time() const noexcept { return true; }
  /// Whether it takes the default before plain accesses that nobody contends for, to memory of a whole program, and is not asked there:
  /// in code without races what could happen there can happen before as well. Asked once an execution.
  [[nodiscard]] virtual bool passes_uncontended() const noexcept { return false; }
  /// Whether the strategy wants to be told each step by performs(). Asked once an execution.
  [[nodiscard]] virtual bool follows_steps() const noexcept { return false; }
  /// Whether choose_task() is to be called while every task stands still, so that World::whole_state() can be asked. Asked once an
  /// execution.
  [[nodiscard]] virtual bool looks_at_states() const noexcept { return false; }
  /// Where states are looked at: every task stands still, and `task` is the only one that can go on, which is no choice.
  virtual void only_one_can_run(TaskId /*task*/) noexcept {}
  /// `task` goes on and performs `operation`, whether or not there was a choice.
  virtual void performs(TaskId /*task*/, const Operation& /*operation*/) noexcept {}
  /// `task` goes on with its operation, which it had to wait in.
  virtual void resumes(TaskId /*task*/, const Operation& /*operation*/) noexcept {}
  /// What the running task performs has turned out to be nothing but a look: it found what others have made, or failed.
  virtual void only_looked() noexcept {}

 protected:
  Strategy() = default;
  Strategy(const Strategy&) = default;
  Strategy& operator=(const Strategy&) = default;
};

}  // namespace ltsim
