#include "sim_clock/world/scheduler.hpp"

#include <algorithm>
#include <utility>

#include "sim_clock/check/no_progress.hpp"
#include "sim_clock/check/self_check.hpp"
#include "sim_clock/world/wipe_stack.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {

constinit thread_local Task* current_task [[gnu::tls_model("initial-exec")]] = nullptr;

void Scheduler::reset(Strategy& strategy, StepListener* listener) noexcept {
  strategy_ = &strategy;
  strategy_follows_steps_ = strategy.follows_steps();
  passes_uncontended_ = strategy.passes_uncontended();
  decides_apart_ = strategy.looks_at_states();
  point_cost_ = strategy.points_cost_time() ? point_cost : SimTime{0};
  listener_ = listener;
  running_ = nullptr;
  clock_.reset();
  runnable_.fill(0);
  under_way_.fill(0);
  runnable_count_ = 0;
  stalled_count_ = 0;
  for (std::size_t i = 0; i < tasks_count_; ++i) {
    Task& task = *tasks_[i];
    // Of a task that was dropped nothing is unwound, and so nothing that its body holds is destroyed either.
    if (task.state != Task::State::finished)
      static_cast<void>(new std::function<void()>(std::move(task.body)));
    task.body = nullptr;
    task.thread_local_destructors.clear();
    task.cleanup_buffers.clear();
  }
  tasks_count_ = 0;
  unfinished_count_ = 0;
  unfinished_in_.fill(0);
  no_processor_before_.fill(SimTime{0});
  points_ = 0;
  set_points_max(points_max_default);
  decisions_ = 0;
  blocked_ever_ = 0;
  hash_ = 0;
  clock_was_read_ = false;
  has_run_ = false;
  cpu_ = Cpu::many;
  ready_ever_ = 0;
  steps_are_checked_ = false;
  is_steady_ = false;
  is_abandoned_ = false;
  outcome_.kind = OutcomeKind::passed;
  outcome_.message.clear();
  describe_outcome_ = nullptr;
  idle_checks_.clear();
  held_up_notes_.clear();
}

void Scheduler::run() {
  LTSIM_CHECK(current_task == nullptr);
  has_run_ = true;
  if (!outcome_.passed() || unfinished_count_ == 0) return;
  main_context_.adopt_current();
  if (decides_apart_) {
    if (decider_storage_ == nullptr) decider_storage_ = std::make_unique<TaskStorage>();
    decider_storage_->reset();
    decider_context_.prepare(decider_storage_->stack_top(), decider_storage_->thread_pointer(), &run_decider,
                             this);
  }
  const auto options = candidates(0);
  running_ = tasks_[options.size() == 1 ? options[0] : choose_task(options, 0, false)].get();
  Context::switch_between(main_context_, running_->context);
  describe_failure();
}

inline bool Scheduler::gives_way(Task& task, Operation operation) noexcept {
  const bool looks = can_be_polling(operation.kind) ||
                     (operation.kind == OperationKind::atomic_update && task.update_failed);
  task.update_failed = false;
  if (!looks) {
    task.looks_count = 0;
    return false;
  }
  constexpr std::uint32_t longest_loop = 8;  // looks between two looks at the same thing
  if (operation == task.looked_at) {
    ++task.looks_count;
    task.steps_since_look = 0;
  } else if (++task.steps_since_look > longest_loop || task.looks_count == 0) {
    task.looked_at = operation;
    task.looks_count = 1;
    task.steps_since_look = 0;
  }
  return operation.kind == OperationKind::yield || task.looks_count >= looks_before_giving_way;
}

[[gnu::always_inline]] inline void Scheduler::pass_point(Operation operation) noexcept {
  Task& self = *running_;
  // What follows looks at the copy: a parameter with an address would be written to the stack and read back at once.
  Operation& pending = pending_[self.id];
  pending = operation;
  clock_.pass(point_cost_);
  ++points_;
  others_ran_ = false;
  bool fair_tail = in_fair_tail();
  if (fair_tail) [[unlikely]]
    pass_fair_tail(self, pending);
  if (listener_ != nullptr) [[unlikely]]
    listener_->arrives(self, pending);
  if (clock_.any_armed() && clock_.next_deadline() <= clock_.now()) wake_due();
  const bool give_way = gives_way(self, operation);
  // Where others must run, or there is one processor, somebody may be waiting for just this point.
  const bool is_passed = operation.object >= first_program_object && passes_uncontended_ &&
                         !operation.is_contended && is_plain_access(operation.kind) && !give_way &&
                         !fair_tail && cpu_ == Cpu::many;
  if (world_.faults().any_at_each_point() && !is_passed) [[unlikely]] {
    if (world_.faults().crash_is_possible()) world_.faults().choose_crash();
    if (self.state == Task::State::killed) leave_killed();
    if (world_.faults().can_strike(FaultKind::process_stall)) world_.faults().choose_stall();
    wait_for_processor();
    fair_tail = in_fair_tail();
  }
  if (fair_tail && give_way) [[unlikely]]
    skip_time_if_all_give_way();
  if ((clock_.any_armed() || clock_was_read_) && !is_passed) {
    choose_slow_moment();
    fair_tail = in_fair_tail();
  }
  if (runnable_count_ > 1 && !is_passed) {
    // Who gives way wants somebody else to run: the default is then the next task, and this one comes last.
    const auto from = static_cast<TaskId>(self.id + (give_way || fair_tail ? 1 : 0));
    if (cpu_ != Cpu::many && pending.kind == OperationKind::yield) self.ready_since = ready_ever_++;
    const auto options = candidates(from);
    const TaskId next =
        options.size() == 1 ? static_cast<TaskId>(options[0]) : choose_task(options, self.id, give_way);
    if (next != self.id) switch_to(*tasks_[next]);
  }
  // Of an address, where there is no object, nothing goes in: it differs from run to run. As a mask and not as a branch, which
  // could not be foreseen.
  const std::uint32_t offset_counts = 0U - static_cast<std::uint32_t>(pending.object != 0);
  mix(std::uint64_t{self.id} << 48U | std::uint64_t{static_cast<std::uint8_t>(pending.kind)} << 40U |
      std::uint64_t{pending.bytes} << 32U | (pending.offset & offset_counts));
  mix(std::uint64_t{pending.object} << 56U ^ static_cast<std::uint64_t>(clock_.now().count()));
  if (strategy_follows_steps_) strategy_->performs(self.id, pending);
  if (listener_ != nullptr) [[unlikely]]
    listener_->performs(self, pending);
  if (steps_are_checked_) [[unlikely]]
    world_.check_step(self, pending);
}

void Scheduler::point(Operation operation) noexcept {
  if (!decides_apart_) [[likely]]
    return pass_point(operation);
  struct Call {
    Scheduler& scheduler;
    const Operation& operation;
  } call{*this, operation};
  const auto pass = [](void* of) noexcept -> std::uint64_t {
    static_cast<Call*>(of)->scheduler.pass_point(static_cast<Call*>(of)->operation);
    return 0;
  };
  ltsim_keep_registers_and_call(&running_->stands_at, pass, &call);
  wipe_stack<cleaned_after_each_stop>();
}

[[gnu::always_inline]] inline Scheduler::Wake Scheduler::block_running(WaitKey key,
                                                                       Deadline deadline) noexcept {
  Task& self = *running_;
  self.state = Task::State::blocked;
  self.wait_key = key;
  self.blocked_since = blocked_ever_++;
  self.deadline = world_.sim_time_of(deadline);
  self.deadline_on_wall_clock = deadline.on_wall_clock;
  self.timed_out = false;
  make_unrunnable(self);
  if (self.deadline != VirtualClock::never) clock_.arm(self.deadline, self.id);
  if (listener_ != nullptr) [[unlikely]]
    listener_->blocks(self);
  if (deadline.on_wall_clock) [[unlikely]]
    world_.choose_clock_step();
  const std::uint64_t bit = std::uint64_t{1} << (self.id % 64);
  under_way_[self.id / 64] |= bit;
  Task* const next = next_after_stop();
  if (next != &self) switch_to(*next);
  under_way_[self.id / 64] &= ~bit;
  if (strategy_follows_steps_) strategy_->resumes(self.id, pending_[self.id]);
  return self.timed_out ? Wake::timed_out : Wake::signalled;
}

Scheduler::Wake Scheduler::block(WaitKey key, Deadline deadline) noexcept {
  if (!decides_apart_) [[likely]]
    return block_running(key, deadline);
  struct Call {
    Scheduler& scheduler;
    WaitKey key;
    Deadline deadline;
  } call{*this, key, deadline};
  const auto block = [](void* of) noexcept -> std::uint64_t {
    const Call& it = *static_cast<Call*>(of);
    return static_cast<std::uint64_t>(it.scheduler.block_running(it.key, it.deadline));
  };
  const auto wake = static_cast<Wake>(ltsim_keep_registers_and_call(&running_->stands_at, block, &call));
  wipe_stack<cleaned_after_each_stop>();
  return wake;
}

std::size_t Scheduler::wake(WaitKey key, std::size_t count_max) noexcept {
  std::size_t woken = 0;
  if (unfinished_count_ == runnable_count_ + stalled_count_) return woken;  // nobody is blocked
  for (; woken < count_max; ++woken) {
    Task* longest = nullptr;
    for (std::size_t i = 0; i < tasks_count_; ++i) {
      Task& task = *tasks_[i];
      if (task.state != Task::State::blocked || task.wait_key != key) continue;
      if (longest == nullptr || goes_before(task, *longest)) longest = &task;
    }
    if (longest == nullptr) break;
    if (longest->deadline != VirtualClock::never) clock_.cancel(longest->id);
    make_runnable(*longest);
  }
  return woken;
}

std::size_t Scheduler::choose(std::string_view what, std::size_t count) noexcept {
  LTSIM_CHECK(count >= 1);
  if (count == 1) return 0;
  if (listener_ != nullptr) {
    std::string question{what};
    make_one_word(question);
    listener_->asks(running_, question);
  }
  ++decisions_;
  const std::size_t chosen = strategy_->answer(count);
  LTSIM_CHECK(chosen < count);
  mix(chosen);
  return chosen;
}

std::size_t Scheduler::choose_age(std::span<const std::uint32_t> ages, bool stores) noexcept {
  if (in_fair_tail()) [[unlikely]]
    return 0;
  ++decisions_;
  const std::size_t chosen = strategy_->choose_age({.ages = ages, .stores = stores, .running = running_->id});
  LTSIM_CHECK(chosen < ages.size());
  mix(ages[chosen]);
  return chosen;
}

void Scheduler::leave(Task& self) noexcept {
  Task* const next = next_after_stop();
  if (next != nullptr) {
    switch_to(*next);
  } else {
    running_ = nullptr;
    Context::switch_between(self.context, main_context_);
  }
}

void Scheduler::fail(OutcomeKind kind, std::string message) {
  if (outcome_.passed()) {
    outcome_.kind = kind;
    outcome_.message = std::move(message);
  }
  if (running_ == nullptr) return;
  Task& self = *running_;
  running_ = nullptr;
  Context::switch_between(self.context, main_context_);
  LTSIM_UNREACHABLE("a task of a failed execution was resumed");
}

void Scheduler::fail_described(OutcomeKind kind, std::function<std::string()> describe) {
  if (outcome_.passed()) describe_outcome_ = std::move(describe);
  fail(kind, std::string{});
  describe_failure();
}

void Scheduler::describe_failure() {
  if (const auto describe = std::exchange(describe_outcome_, nullptr); describe)
    outcome_.message = describe();
}

void Scheduler::abandon() noexcept {
  is_abandoned_ = true;
  fail(OutcomeKind::passed, {});
}

Task* Scheduler::next_after_stop() noexcept {
  if (unfinished_count_ == 0) return nullptr;
  wake_due();
  while (runnable_count_ == 0) nobody_can_run();
  if (clock_.any_armed()) let_time_pass(false);
  const auto options = candidates(0);
  const bool is_forced = options.size() == 1 && !decides_apart_;
  return tasks_[is_forced ? options[0] : choose_task(options, running_->id, false)].get();
}

void Scheduler::nobody_can_run() noexcept {
  if (!idle_checks_.empty() && stalled_count_ == 0) {
    const GhostScope ghost;
    for (const auto& check : idle_checks_) check();
    if (runnable_count_ != 0) return;  // it has sent somebody a signal
  }
  if (!clock_.any_armed()) {
    const GhostScope ghost;
    fail(OutcomeKind::deadlock, describe_deadlock(world_));
  }
  const SimTime until_next = std::max(clock_.next_deadline() - clock_.now(), SimTime{0});
  if (stalled_count_ == 0) {
    clock_.pass(until_next);
  } else {
    pass_held_up(until_next);
  }
  wake_due();
}

TaskId Scheduler::choose_task(std::span<const std::uint64_t> options, TaskId running,
                              bool running_gives_way) noexcept {
  if (in_fair_tail()) [[unlikely]]
    return static_cast<TaskId>(options[0]);
  ++decisions_;
  choice_.options = options;
  choice_.running = running;
  choice_.running_gives_way = running_gives_way;
  if (decides_apart_ && running_ != nullptr) [[unlikely]]
    return decide_apart();
  return static_cast<TaskId>(options[strategy_->choose_task(choice_)]);
}

SlowMoment Scheduler::let_time_pass(bool running_can_be_held_up) noexcept {
  if (in_fair_tail() || is_steady_) [[unlikely]]
    return {};
  for (unsigned i = 0; i < slow_moments_max; ++i) {
    ++decisions_;
    const SimTime next = clock_.next_deadline();
    const SlowMoment moment =
        strategy_->slow_moment({.until_next_timer = next == VirtualClock::never ? next : next - clock_.now(),
                                .running = running_->id,
                                .running_can_be_held_up = running_can_be_held_up,
                                .runnable = runnable_,
                                .pending = pending_,
                                .under_way = under_way_});
    if (moment.duration == SimTime{0}) return {};
    if (moment.others_go_on) return moment;
    pass_held_up(moment.duration);
    wake_due();
  }
  return {};
}

void Scheduler::pass_held_up(SimTime duration) noexcept {
  clock_.pass(duration);
  if (held_up_notes_.empty()) return;
  const GhostScope ghost;
  for (const auto& note : held_up_notes_) note(duration);
}

void Scheduler::choose_slow_moment() noexcept {
  const SlowMoment moment = let_time_pass(true);
  if (moment.duration == SimTime{0}) return;
  Task& self = *running_;
  self.state = Task::State::stalled;
  ++stalled_count_;
  make_unrunnable(self);
  clock_.arm(clock_.now() + moment.duration, self.id);
  if (listener_ != nullptr) listener_->held_up(self, moment.duration);
  self.is_held_up_at_point = true;
  Task* const other = next_after_stop();
  if (other != &self) switch_to(*other);
  self.is_held_up_at_point = false;
  if (listener_ != nullptr) listener_->goes_on(self);
}

std::span<const std::uint64_t> Scheduler::many_runnable_tasks(TaskId from) noexcept {
  std::size_t count = 0;
  const auto append = [&](std::size_t word, std::uint64_t mask) {
    for (std::uint64_t bits = runnable_[word] & mask; bits != 0; bits &= bits - 1) {
      options_[count++] = word * 64 + static_cast<std::uint64_t>(std::countr_zero(bits));
    }
  };
  constexpr std::uint64_t all = ~std::uint64_t{0};
  const std::size_t first_word = from % tasks_max / 64;
  const std::uint64_t not_before = all << (from % 64);
  const std::size_t words_count = (tasks_count_ + 63) / 64;
  append(first_word, not_before);
  for (std::size_t word = first_word + 1; word < words_count; ++word) append(word, all);
  for (std::size_t word = 0; word < first_word; ++word) append(word, all);
  append(first_word, ~not_before);
  return std::span{options_}.first(count);
}

void Scheduler::switch_to(Task& next) noexcept {
  Task& self = *running_;
  running_ = &next;
  others_ran_ = true;  // while the next one stood still
  Context::switch_between(self.context, next.context);
}

void Scheduler::wake_due() noexcept {
  for (TaskId sleeper = clock_.take_due(); sleeper != VirtualClock::no_task; sleeper = clock_.take_due()) {
    Task& task = *tasks_[sleeper];
    if (task.state == Task::State::stalled) {
      --stalled_count_;
    } else {
      task.timed_out = true;
    }
    make_runnable(task);
  }
}

void Scheduler::make_runnable(Task& task) noexcept {
  if (clock_.now() < no_processor_before_[task.process]) [[unlikely]] {
    task.state = Task::State::stalled;
    ++stalled_count_;
    clock_.arm(no_processor_before_[task.process], task.id);
    return;
  }
  task.state = Task::State::runnable;
  task.ready_since = ready_ever_++;
  runnable_[task.id / 64] |= std::uint64_t{1} << (task.id % 64);
  ++runnable_count_;
}

void Scheduler::make_unrunnable(const Task& task) noexcept {
  runnable_[task.id / 64] &= ~(std::uint64_t{1} << (task.id % 64));
  --runnable_count_;
}

}  // namespace ltsim
