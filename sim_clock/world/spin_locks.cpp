#include "sim_clock/world/spin_locks.hpp"

#include <cerrno>

#include <fmt/format.h>

#include "sim_clock/world/object_key.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

/// glibc: sysdeps/i386/nptl/pthread_spin_init.c.
constexpr int free_lock = 1;

}  // namespace

void SpinLocks::was_made(pthread_spinlock_t* lock) noexcept {
  world_.segments().accept_change(const_cast<const int*>(lock), sizeof *lock);
  const GhostScope ghost;
  by_place_.erase(Segments::canonical(lock));
}

SpinLocks::Lock& SpinLocks::resolve(pthread_spinlock_t* lock, OperationKind kind) noexcept {
  const auto found = by_place_.find(Segments::canonical(lock));
  if (found != by_place_.end()) return locks_[found->second];
  const bool was_made = *lock == free_lock;
  const GhostScope ghost;
  if (!was_made) {
    world_.scheduler().fail(OutcomeKind::crash,
                            fmt::format("{} on memory that holds no spin lock", to_string(kind)));
  }
  by_place_.emplace(Segments::canonical(lock), locks_.size());
  const ObjectId object = world_.objects().add(
      world_.program_memory().object_name(const_cast<const int*>(lock), "spin-lock", locks_.size() + 1));
  return locks_.emplace_back(Lock{.object = object, .owner_plus_one = 0});
}

int SpinLocks::lock(pthread_spinlock_t* lock) noexcept {
  constexpr OperationKind kind = OperationKind::spin_lock;
  Scheduler& scheduler = world_.scheduler();
  const ObjectId object = resolve(lock, kind).object;
  scheduler.point({.kind = kind, .object = object});
  // Each time anew: while others run, the lock may be made again, and others be used for the first time.
  while (resolve(lock, kind).owner_plus_one != 0) {
    if (scheduler.cpu() == Cpu::many) {
      scheduler.block(object_key(object, true), VirtualClock::never);
    } else {
      scheduler.point({.kind = kind, .object = object});
    }
  }
  take(resolve(lock, kind));
  return 0;
}

int SpinLocks::try_lock(pthread_spinlock_t* lock) noexcept {
  constexpr OperationKind kind = OperationKind::spin_trylock;
  world_.scheduler().point({.kind = kind, .object = resolve(lock, kind).object});
  Lock& state = resolve(lock, kind);
  if (state.owner_plus_one != 0) {
    world_.scheduler().only_looked();
    return EBUSY;
  }
  take(state);
  return 0;
}

void SpinLocks::take(Lock& lock) noexcept {
  lock.owner_plus_one = current_task->id + 1U;
  world_.checks().acquire(current_task->id, SyncKey::object(lock.object));
}

int SpinLocks::unlock(pthread_spinlock_t* lock) noexcept {
  constexpr OperationKind kind = OperationKind::spin_unlock;
  world_.scheduler().point({.kind = kind, .object = resolve(lock, kind).object});
  Lock& state = resolve(lock, kind);
  if (state.owner_plus_one != current_task->id + 1U) {
    const std::string& task = current_task->name;
    const GhostScope ghost;
    world_.scheduler().fail(OutcomeKind::assertion,
                            fmt::format("{} is released by {}, which does not hold it",
                                        world_.objects().object_name(state.object), task));
  }
  state.owner_plus_one = 0;
  world_.checks().release(current_task->id, SyncKey::object(state.object));
  world_.scheduler().wake(object_key(state.object, true), tasks_max);
  return 0;
}

int SpinLocks::destroy(pthread_spinlock_t* lock) noexcept {
  const auto found = by_place_.find(Segments::canonical(lock));
  if (found == by_place_.end()) return 0;
  if (locks_[found->second].owner_plus_one != 0) return EBUSY;
  const GhostScope ghost;
  by_place_.erase(found);
  return 0;
}

const Task* SpinLocks::owner_of(ObjectId lock) const noexcept {
  for (const Lock& each : locks_) {
    if (each.object == lock && each.owner_plus_one != 0)
      return &world_.scheduler().task(static_cast<TaskId>(each.owner_plus_one - 1));
  }
  return nullptr;
}

std::string SpinLocks::held_at_end() const {
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

void SpinLocks::add_state(StateHash& hash) const noexcept {
  hash.add(locks_.size());
  for (const Lock& lock : locks_) hash.add(std::uint64_t{lock.object} << 32U | lock.owner_plus_one);
  std::uint64_t places = 0;  // in no order that means anything
  for (const auto& [place, index] : by_place_) {
    StateHash of_place{world_.execution_number()};
    of_place.add_word(place);
    of_place.add(index);
    places += of_place.value();
  }
  hash.add(places);
}

}  // namespace ltsim
