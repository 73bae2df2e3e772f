#include "sim_clock/world/rwlocks.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>

#include <fmt/format.h>

#include "sim_clock/world/object_key.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {

/// Our use of the bytes of a pthread_rwlock_t. `shared` and `kind` are glibc's own fields:
/// sysdeps/x86/nptl/bits/struct_rwlock.h.
struct Rwlocks::State {
  std::uint32_t writer_plus_one;  // 0: nobody writes
  std::uint32_t readers_count;    // as often as they hold it
  std::uint64_t execution;        // in which the fields around it are valid
  std::uint32_t number;           // of the lock, from 0, in this execution
  ObjectId object;
  std::uint32_t writers_waiting;
  std::int32_t shared;
  std::uint64_t unused[2];
  std::uint32_t kind;
};

Rwlocks::State& Rwlocks::resolve(pthread_rwlock_t* lock) noexcept {
  static_assert(sizeof(State) == sizeof(pthread_rwlock_t));
  static_assert(offsetof(State, shared) == offsetof(pthread_rwlock_t, __data.__shared));
  static_assert(offsetof(State, kind) == offsetof(pthread_rwlock_t, __data.__flags));
  auto& state = *reinterpret_cast<State*>(lock);
  if (state.execution != world_.execution_number() || state.number >= locks_.size()) {
    state.writer_plus_one = 0;
    state.readers_count = 0;
    state.writers_waiting = 0;
    state.execution = world_.execution_number();
    const GhostScope ghost;
    state.number = static_cast<std::uint32_t>(locks_.size());
    state.object =
        world_.objects().add(world_.program_memory().object_name(lock, "rwlock", locks_.size() + 1));
    locks_.push_back({.object = state.object, .writer_plus_one = 0});
    state_changed(state);
  }
  return state;
}

WaitKey Rwlocks::key_of(const State& state) noexcept { return object_key(state.object, state.shared != 0); }

/// For a writer that waits, although others read.
bool Rwlocks::readers_wait(const State& state) noexcept {
  return state.kind == PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP && state.writers_waiting != 0;
}

int Rwlocks::lock_to_read(pthread_rwlock_t* lock) noexcept {
  return acquire_to_read(lock, OperationKind::rwlock_rdlock, VirtualClock::never);
}

int Rwlocks::timed_lock_to_read(pthread_rwlock_t* lock, Deadline deadline) noexcept {
  return acquire_to_read(lock, OperationKind::rwlock_timedrdlock, deadline);
}

int Rwlocks::lock_to_write(pthread_rwlock_t* lock) noexcept {
  return acquire_to_write(lock, OperationKind::rwlock_wrlock, VirtualClock::never);
}

int Rwlocks::timed_lock_to_write(pthread_rwlock_t* lock, Deadline deadline) noexcept {
  return acquire_to_write(lock, OperationKind::rwlock_timedwrlock, deadline);
}

int Rwlocks::acquire_to_read(pthread_rwlock_t* lock, OperationKind kind, Deadline deadline) noexcept {
  State& state = resolve(lock);
  world_.point_at(lock, {.kind = kind, .object = state.object});
  if (state.writer_plus_one == current_task->id + 1U) return EDEADLK;
  const auto must_wait = [&state] { return state.writer_plus_one != 0 || readers_wait(state); };
  while (must_wait()) {
    if (world_.scheduler().block(key_of(state), deadline) == Scheduler::Wake::timed_out && must_wait())
      return ETIMEDOUT;
  }
  take_to_read(state);
  return 0;
}

int Rwlocks::try_to_read(pthread_rwlock_t* lock) noexcept {
  State& state = resolve(lock);
  world_.point_at(lock, {.kind = OperationKind::rwlock_tryrdlock, .object = state.object});
  if (state.writer_plus_one != 0 || readers_wait(state)) {
    world_.scheduler().only_looked();
    return EBUSY;
  }
  take_to_read(state);
  return 0;
}

int Rwlocks::acquire_to_write(pthread_rwlock_t* lock, OperationKind kind, Deadline deadline) noexcept {
  State& state = resolve(lock);
  world_.point_at(lock, {.kind = kind, .object = state.object});
  if (state.writer_plus_one == current_task->id + 1U) return EDEADLK;
  const auto must_wait = [&state] { return state.writer_plus_one != 0 || state.readers_count != 0; };
  while (must_wait()) {
    ++state.writers_waiting;
    state_changed(state);
    const auto wake = world_.scheduler().block(key_of(state), deadline);
    --state.writers_waiting;
    state_changed(state);
    if (wake != Scheduler::Wake::timed_out || !must_wait()) continue;
    // Readers may have waited for this writer alone.
    world_.scheduler().wake(key_of(state), tasks_max);
    return ETIMEDOUT;
  }
  take_to_write(state);
  return 0;
}

int Rwlocks::try_to_write(pthread_rwlock_t* lock) noexcept {
  State& state = resolve(lock);
  world_.point_at(lock, {.kind = OperationKind::rwlock_trywrlock, .object = state.object});
  if (state.writer_plus_one != 0 || state.readers_count != 0) {
    world_.scheduler().only_looked();
    return EBUSY;
  }
  take_to_write(state);
  return 0;
}

void Rwlocks::take_to_read(State& state) {
  const TaskId self = current_task->id;
  ++state.readers_count;
  const auto held = std::find_if(readers_.begin(), readers_.end(), [&](const Reader& reader) {
    return reader.lock == state.number && reader.task == self;
  });
  if (held != readers_.end()) {
    ++held->count;
  } else {
    const GhostScope ghost;
    readers_.push_back({.lock = state.number, .task = self, .count = 1});
  }
  world_.checks().acquire(self, SyncKey::object(state.object));
  state_changed(state);
}

void Rwlocks::take_to_write(State& state) noexcept {
  const TaskId self = current_task->id;
  state.writer_plus_one = self + 1U;
  locks_[state.number].writer_plus_one = self + 1U;
  world_.checks().acquire(self, SyncKey::object(state.object));
  world_.checks().acquire(self, SyncKey::readers(state.object));
  state_changed(state);
}

int Rwlocks::unlock(pthread_rwlock_t* lock) noexcept {
  State& state = resolve(lock);
  world_.point_at(lock, {.kind = OperationKind::rwlock_unlock, .object = state.object});
  if (state.writer_plus_one == current_task->id + 1U) {
    state.writer_plus_one = 0;
    locks_[state.number].writer_plus_one = 0;
    world_.checks().release(current_task->id, SyncKey::object(state.object));
  } else if (leave_as_reader(state)) {
    world_.checks().release(current_task->id, SyncKey::readers(state.object));
  } else {
    const std::string& task = current_task->name;
    const GhostScope ghost;
    world_.scheduler().fail(OutcomeKind::assertion,
                            fmt::format("{} is released by {}, which does not hold it",
                                        world_.objects().object_name(state.object), task));
  }
  state_changed(state);
  if (state.readers_count == 0) world_.scheduler().wake(key_of(state), tasks_max);
  return 0;
}

bool Rwlocks::leave_as_reader(State& state) noexcept {
  const TaskId self = current_task->id;
  const auto held = std::find_if(readers_.begin(), readers_.end(), [&](const Reader& reader) {
    return reader.lock == state.number && reader.task == self;
  });
  if (held == readers_.end()) return false;
  if (--held->count == 0) readers_.erase(held);
  --state.readers_count;
  return true;
}

int Rwlocks::destroy(pthread_rwlock_t* lock) noexcept {
  State& state = resolve(lock);
  if (state.writer_plus_one != 0 || state.readers_count != 0) return EBUSY;
  state.execution = 0;
  state_changed(state);
  return 0;
}

void Rwlocks::state_changed(const State& state) noexcept {
  world_.segments().accept_change(&state, sizeof state);
}

bool Rwlocks::belongs_to_an_execution(const pthread_rwlock_t* lock) noexcept {
  return World::is_execution_number(reinterpret_cast<const State*>(lock)->execution);
}

std::vector<TaskId> Rwlocks::holders_of(ObjectId lock) const {
  std::vector<TaskId> holders;
  for (std::size_t i = 0; i < locks_.size(); ++i) {
    if (locks_[i].object != lock) continue;
    if (locks_[i].writer_plus_one != 0) holders.push_back(static_cast<TaskId>(locks_[i].writer_plus_one - 1));
    for (const Reader& reader : readers_) {
      if (reader.lock == i) holders.push_back(reader.task);
    }
  }
  return holders;
}

std::string Rwlocks::held_at_end() const {
  std::string text;
  for (const Lock& lock : locks_) {
    for (const TaskId holder : holders_of(lock.object)) {
      const Task& task = world_.scheduler().task(holder);
      // Who is killed cannot unlock, and who was under way when the scenario had seen enough still might have.
      if (task.state != Task::State::finished) continue;
      text += fmt::format("{}{} is still held by {}, which has ended", text.empty() ? "" : "; ",
                          world_.objects().object_name(lock.object), task.name);
    }
  }
  return text;
}

void Rwlocks::add_state(StateHash& hash) const noexcept {
  hash.add(std::uint64_t{locks_.size()} << 32U | readers_.size());
  for (const Lock& lock : locks_) hash.add(std::uint64_t{lock.object} << 32U | lock.writer_plus_one);
  for (const Reader& reader : readers_)
    hash.add(std::uint64_t{reader.lock} << 48U | std::uint64_t{reader.task} << 32U | reader.count);
}

}  // namespace ltsim
