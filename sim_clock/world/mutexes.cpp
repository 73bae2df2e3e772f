#include "sim_clock/world/mutexes.hpp"

#include <cerrno>

#include <fmt/format.h>

#include "sim_clock/world/segments.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {

/// Our use of the bytes of a pthread_mutex_t. `kind` is glibc's own field:
/// sysdeps/x86/nptl/bits/struct_mutex.h.
struct Mutexes::State {
  std::uint32_t owner_plus_one;  // 0: free
  std::uint32_t locked_count;    // of a recursive mutex
  std::uint64_t execution;       // in which the fields around it are valid
  std::int32_t kind;
  ObjectId object;
  enum class Health : std::uint32_t {
    sound,
    owner_died,       // the next who locks it is told
    inconsistent,     // locked by one who was told
    not_recoverable,  // who was told unlocked it without pthread_mutex_consistent()
  } health;
  std::uint32_t number;  // of the mutex, from 0, in this execution
  std::uint32_t unused[2];
};

namespace {

constexpr std::int32_t kind_mask = 3;  // glibc keeps robustness, sharing and protocol in higher bits

/// nptl/pthreadP.h, PTHREAD_MUTEX_ROBUST_NORMAL_NP.
constexpr bool is_robust(std::int32_t kind) noexcept { return (kind & 16) != 0; }

Operation operation_on(OperationKind kind, ObjectId object = 0) noexcept {
  return {.kind = kind, .object = object};
}

/// What is not meant for several processes wakes only those who reach it at the same address: in a segment,
/// tasks of the same process. The bits for it are glibc's: nptl/pthreadP.h, PTHREAD_MUTEX_PSHARED_BIT and
/// __PTHREAD_COND_SHARED_MASK.
WaitKey wait_key(const void* address, bool shared) noexcept {
  return shared ? Segments::canonical(address) : reinterpret_cast<WaitKey>(address);
}

/// glibc: nptl/pthreadP.h, PTHREAD_MUTEX_PRIO_INHERIT_NP.
bool inherits_priority(std::int32_t kind) noexcept { return (kind & 32) != 0; }

WaitKey condition_key(const pthread_cond_t* condition) noexcept {
  constexpr unsigned shared_between_processes = 1;
  return wait_key(condition, (condition->__data.__wrefs & shared_between_processes) != 0);
}

}  // namespace

/// Conditions and futex words share their addresses with nothing else that is waited for, but a mutex may be
/// the first member of a structure whose address is waited for too.
WaitKey Mutexes::mutex_key(const void* address, std::int32_t kind) noexcept {
  constexpr std::int32_t shared_between_processes = 128;
  return wait_key(address, (kind & shared_between_processes) != 0) | mutex_key_mark;
}

void Mutexes::reset() noexcept {
  locks_.clear();
  robust_held_.clear();
}

Mutexes::State& Mutexes::resolve(pthread_mutex_t* mutex) noexcept {
  static_assert(sizeof(State) == sizeof(pthread_mutex_t));
  static_assert(offsetof(State, kind) == offsetof(pthread_mutex_t, __data.__kind));
  auto& state = *reinterpret_cast<State*>(mutex);
  if (state.execution != world_.execution_number() || state.number >= locks_.size()) {
    state.owner_plus_one = 0;
    state.locked_count = 0;
    state.health = State::Health::sound;
    state.execution = world_.execution_number();
    const GhostScope ghost;
    state.number = static_cast<std::uint32_t>(locks_.size());
    state.object =
        world_.objects().add(world_.program_memory().object_name(mutex, "mutex", locks_.size() + 1));
    locks_.push_back({.object = state.object, .owner_plus_one = 0});
    state_changed(state);
  }
  return state;
}

int Mutexes::lock(pthread_mutex_t* mutex) noexcept {
  State& state = resolve(mutex);
  return acquire(state, mutex, OperationKind::mutex_lock, VirtualClock::never);
}

int Mutexes::timed_lock(pthread_mutex_t* mutex, Deadline deadline) noexcept {
  State& state = resolve(mutex);
  return acquire(state, mutex, OperationKind::mutex_timedlock, deadline);
}

int Mutexes::try_lock(pthread_mutex_t* mutex) noexcept {
  State& state = resolve(mutex);
  world_.point_at(mutex, operation_on(OperationKind::mutex_trylock, state.object));
  const std::uint32_t self = current_task->id + 1U;
  if (state.owner_plus_one == self && (state.kind & kind_mask) == PTHREAD_MUTEX_RECURSIVE) {
    ++state.locked_count;
    state_changed(state);
    return 0;
  }
  if (state.owner_plus_one != 0) {
    world_.scheduler().only_looked();
    return EBUSY;
  }
  return take(state, mutex);
}

int Mutexes::acquire(State& state, const void* address, OperationKind kind, Deadline deadline) noexcept {
  world_.point_at(static_cast<const pthread_mutex_t*>(address), operation_on(kind, state.object));
  const std::uint32_t self = current_task->id + 1U;
  if (state.owner_plus_one == self) {
    if ((state.kind & kind_mask) == PTHREAD_MUTEX_RECURSIVE) {
      ++state.locked_count;
      state_changed(state);
      return 0;
    }
    if ((state.kind & kind_mask) == PTHREAD_MUTEX_ERRORCHECK) return EDEADLK;
  }
  while (state.owner_plus_one != 0) {
    if (wait_for_owner(state, address, deadline) == Scheduler::Wake::timed_out && state.owner_plus_one != 0) {
      return ETIMEDOUT;
    }
  }
  return take(state, address);
}

int Mutexes::take(State& state, const void* address) noexcept {
  if (state.health == State::Health::not_recoverable) return ENOTRECOVERABLE;
  set_owner(state, current_task->id + 1U);
  state.locked_count = 1;
  world_.checks().acquire(current_task->id, SyncKey::object(state.object));
  state_changed(state);
  if (inherits_priority(state.kind))
    world_.scheduler().end_lending(mutex_key(address, state.kind), current_task);
  if (!is_robust(state.kind)) return 0;
  robust_held_.push_back({.state = &state, .address = address, .owner = current_task->id});
  if (state.health == State::Health::sound) return 0;
  state.health = State::Health::inconsistent;
  state_changed(state);
  return EOWNERDEAD;
}

Scheduler::Wake Mutexes::wait_for_owner(const State& state, const void* address, Deadline deadline) noexcept {
  Scheduler& scheduler = world_.scheduler();
  Task& self = *current_task;
  Task& owner = scheduler.task(static_cast<TaskId>(state.owner_plus_one - 1));
  const bool lends = inherits_priority(state.kind);
  if (lends) scheduler.lend_priority(self, owner);
  const auto wake = scheduler.block(mutex_key(address, state.kind), deadline);
  if (lends) {
    self.lends_to = VirtualClock::no_task;
    scheduler.update_priority(owner);
  }
  return wake;
}

void Mutexes::state_changed(const State& state) noexcept {
  world_.segments().accept_change(&state, sizeof state);
}

int Mutexes::unlock(pthread_mutex_t* mutex) noexcept {
  State& state = resolve(mutex);
  world_.point_at(mutex, operation_on(OperationKind::mutex_unlock, state.object));
  if (const int error = check_owner(state); error != 0) return error;
  if (--state.locked_count == 0) release(state, mutex);
  state_changed(state);
  return 0;
}

int Mutexes::check_owner(const State& state) noexcept {
  if (state.owner_plus_one == current_task->id + 1U) return 0;
  if ((state.kind & kind_mask) != PTHREAD_MUTEX_NORMAL || is_robust(state.kind)) return EPERM;
  const std::string& task = current_task->name;
  const GhostScope ghost;
  world_.scheduler().fail(OutcomeKind::assertion,
                          fmt::format("{} is released by {}, which does not hold it",
                                      world_.objects().object_name(state.object), task));
  return EPERM;
}

bool Mutexes::belongs_to_an_execution(const pthread_mutex_t* mutex) noexcept {
  return World::is_execution_number(reinterpret_cast<const State*>(mutex)->execution);
}

int Mutexes::consistent(pthread_mutex_t* mutex) noexcept {
  State& state = resolve(mutex);
  if (state.health != State::Health::inconsistent || state.owner_plus_one != current_task->id + 1U)
    return EINVAL;
  state.health = State::Health::sound;
  state_changed(state);
  return 0;
}

int Mutexes::destroy(pthread_mutex_t* mutex) noexcept {
  State& state = resolve(mutex);
  if (state.owner_plus_one != 0) return EBUSY;
  state.execution = 0;
  state_changed(state);
  return 0;
}

void Mutexes::release(State& state, const void* address) noexcept {
  set_owner(state, 0);
  state.locked_count = 0;
  world_.checks().release(current_task->id, SyncKey::object(state.object));
  Scheduler& scheduler = world_.scheduler();
  const WaitKey key = mutex_key(address, state.kind);
  if (inherits_priority(state.kind)) {
    scheduler.end_lending(key, nullptr);
    scheduler.update_priority(*current_task);
  }
  // Linux hands a mutex that inherits to the waiter of the highest priority, to whom those who go on waiting lend theirs.
  // Here all of them wake and the highest takes it: one that were woken alone, and not the owner yet, would inherit nothing.
  std::size_t woken_max = inherits_priority(state.kind) ? tasks_max : 1;
  if (is_robust(state.kind)) {
    // The state may be reached at another address than it was locked at: another mapping of the process.
    std::erase_if(robust_held_, [&](const RobustHeld& held) {
      return held.owner == current_task->id && Segments::canonical(held.state) == Segments::canonical(&state);
    });
    if (state.health == State::Health::inconsistent) {
      state.health = State::Health::not_recoverable;
      woken_max = tasks_max;  // none of them will have it
    }
  }
  state_changed(state);
  scheduler.wake(key, woken_max);
}

void Mutexes::release_robust_of(TaskId owner) noexcept {
  for (std::size_t i = 0; i < robust_held_.size();) {
    const RobustHeld held = robust_held_[i];
    if (held.owner != owner) {
      ++i;
      continue;
    }
    robust_held_.erase(robust_held_.begin() + static_cast<std::ptrdiff_t>(i));
    State& state = *held.state;
    // Somebody may have made something else of the memory meanwhile.
    if (state.execution != world_.execution_number() || state.owner_plus_one != owner + 1U) continue;
    set_owner(state, 0);
    state.locked_count = 0;
    state.health = State::Health::owner_died;
    // What the dead owner did comes before what the next one does, who is told of its death.
    world_.checks().release(owner, SyncKey::object(state.object));
    state_changed(state);
    world_.scheduler().wake(mutex_key(held.address, state.kind), 1);
  }
}

void Mutexes::set_owner(State& state, std::uint32_t owner_plus_one) noexcept {
  state.owner_plus_one = owner_plus_one;
  locks_[state.number].owner_plus_one = owner_plus_one;
}

const Task* Mutexes::owner_of(ObjectId mutex) const noexcept {
  for (const Lock& lock : locks_) {
    if (lock.object == mutex && lock.owner_plus_one != 0)
      return &world_.scheduler().task(static_cast<TaskId>(lock.owner_plus_one - 1));
  }
  return nullptr;
}

std::string Mutexes::held_at_end() const {
  std::string text;
  for (const Lock& lock : locks_) {
    const Task* const owner = owner_of(lock.object);
    // Who is killed cannot unlock, and who was under way when the scenario had seen enough still might have.
    if (owner == nullptr || owner->state != Task::State::finished) continue;
    text += fmt::format("{}{} is still held by {}, which has ended", text.empty() ? "" : "; ",
                        world_.objects().object_name(lock.object), owner->name);
  }
  return text;
}

int Mutexes::wait(pthread_cond_t* condition, pthread_mutex_t* mutex) noexcept {
  return wait_until(condition, mutex, OperationKind::cond_wait, VirtualClock::never);
}

int Mutexes::timed_wait(pthread_cond_t* condition, pthread_mutex_t* mutex, Deadline deadline) noexcept {
  return wait_until(condition, mutex, OperationKind::cond_timedwait, deadline);
}

int Mutexes::wait_until(pthread_cond_t* condition, pthread_mutex_t* mutex, OperationKind kind,
                        Deadline deadline) noexcept {
  State& state = resolve(mutex);
  world_.scheduler().point(operation_on(kind, state.object));
  if (const int error = check_owner(state); error != 0) return error;
  // Like glibc, one unlock: a recursive mutex that was locked twice stays locked while its owner waits.
  if (--state.locked_count == 0) release(state, mutex);
  state_changed(state);
  const bool spurious = world_.faults().strikes(FaultKind::spurious_wake);
  // One that wakes for nothing can run again at once: when it does, the strategy says.
  const auto wake =
      world_.scheduler().block(condition_key(condition), spurious ? Deadline{world_.now()} : deadline);
  const std::uint32_t self = current_task->id + 1U;
  while (state.owner_plus_one != 0 && state.owner_plus_one != self) {
    wait_for_owner(state, mutex, VirtualClock::never);
  }
  if (state.owner_plus_one == self) {
    ++state.locked_count;  // a recursive one that stayed locked
    state_changed(state);
  } else if (const int error = take(state, mutex); error != 0) {
    return error;
  }
  return wake == Scheduler::Wake::timed_out && !spurious ? ETIMEDOUT : 0;
}

int Mutexes::signal(pthread_cond_t* condition) noexcept {
  world_.point_at(condition, operation_on(OperationKind::cond_signal));
  world_.scheduler().wake(condition_key(condition), 1);
  return 0;
}

int Mutexes::broadcast(pthread_cond_t* condition) noexcept {
  world_.point_at(condition, operation_on(OperationKind::cond_broadcast));
  world_.scheduler().wake(condition_key(condition), tasks_max);
  return 0;
}

int Mutexes::once(pthread_once_t* control, void (*initialise)()) {
  // PTHREAD_ONCE_INIT is 0. What was initialised in an earlier execution stays initialised, like every
  // global.
  constexpr int running = 1;
  constexpr int done = 2;
  world_.scheduler().point(operation_on(OperationKind::once));
  while (*control == running) world_.scheduler().block(Segments::canonical(control), VirtualClock::never);
  const SyncKey key = SyncKey::once(Segments::canonical(control));
  world_.checks().acquire(current_task->id, key);
  if (*control == done) return 0;
  *control = running;
  try {
    initialise();
  } catch (...) {
    *control = 0;  // the next one may try
    world_.checks().release(current_task->id, key);
    world_.scheduler().wake(Segments::canonical(control), tasks_max);
    throw;
  }
  *control = done;
  world_.checks().release(current_task->id, key);
  world_.scheduler().wake(Segments::canonical(control), tasks_max);
  return 0;
}

int Mutexes::futex_wait(const std::uint32_t* word, std::uint32_t expected, Deadline deadline,
                        bool shared) noexcept {
  world_.scheduler().point(operation_on(OperationKind::futex_wait));
  if (*word != expected) {
    errno = EAGAIN;
    return -1;
  }
  const bool spurious = world_.faults().strikes(FaultKind::spurious_wake);
  const auto wake =
      world_.scheduler().block(wait_key(word, shared), spurious ? Deadline{world_.now()} : deadline);
  if (wake == Scheduler::Wake::timed_out && !spurious) {
    errno = ETIMEDOUT;
    return -1;
  }
  world_.checks().acquire(current_task->id, SyncKey::futex(wait_key(word, shared)));
  return 0;
}

int Mutexes::futex_wake(const std::uint32_t* word, std::size_t count_max, bool shared) noexcept {
  world_.scheduler().point(operation_on(OperationKind::futex_wake));
  const WaitKey key = wait_key(word, shared);
  world_.checks().release(current_task->id, SyncKey::futex(key));
  return static_cast<int>(world_.scheduler().wake(key, count_max));
}

void Mutexes::add_state(StateHash& hash) const noexcept {
  hash.add(std::uint64_t{locks_.size()} << 32U | robust_held_.size());
  for (const Lock& lock : locks_) hash.add(std::uint64_t{lock.object} << 32U | lock.owner_plus_one);
  for (const RobustHeld& held : robust_held_) {
    hash.add_word(reinterpret_cast<std::uintptr_t>(held.address));
    hash.add(held.owner);
  }
}

}  // namespace ltsim
