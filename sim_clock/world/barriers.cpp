#include "sim_clock/world/barriers.hpp"

#include <cstddef>
#include <cstring>

#include <fmt/format.h>

#include "sim_clock/world/object_key.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {

/// Our use of the bytes of a pthread_barrier_t. `count` and `shared` are glibc's own fields:
/// sysdeps/nptl/internaltypes.h, struct pthread_barrier.
struct Barriers::State {
  std::uint32_t number;   // of the barrier, from 0, in this execution
  std::uint32_t arrived;  // in this round
  std::uint32_t count;
  std::int32_t shared;
  std::uint64_t execution;  // in which the first two are valid
  std::uint64_t unused;
};

void Barriers::was_made(pthread_barrier_t* barrier) noexcept {
  reinterpret_cast<State*>(barrier)->execution = 0;
  world_.segments().accept_change(barrier, sizeof *barrier);
}

Barriers::State& Barriers::resolve(pthread_barrier_t* barrier) noexcept {
  static_assert(sizeof(State) == sizeof(pthread_barrier_t));
  auto& state = *reinterpret_cast<State*>(barrier);
  if (state.count == 0) {
    const GhostScope ghost;
    world_.scheduler().fail(OutcomeKind::crash, "barrier_wait on memory that holds no barrier");
  }
  if (state.execution != world_.execution_number() || state.number >= barriers_.size()) {
    state.arrived = 0;
    state.execution = world_.execution_number();
    const GhostScope ghost;
    state.number = static_cast<std::uint32_t>(barriers_.size());
    const ObjectId object =
        world_.objects().add(world_.program_memory().object_name(barrier, "barrier", barriers_.size() + 1));
    barriers_.push_back({.object = object, .count = state.count, .waiting = {}});
    world_.segments().accept_change(&state, sizeof state);
  }
  return state;
}

int Barriers::wait(pthread_barrier_t* barrier) noexcept {
  const ObjectId object = barriers_[resolve(barrier).number].object;
  world_.point_at(barrier, {.kind = OperationKind::barrier_wait, .object = object});
  State& state = resolve(barrier);
  Barrier& of = barriers_[state.number];
  const SyncKey sync = SyncKey::object(of.object);
  const WaitKey key = object_key(of.object, state.shared != 0);
  const TaskId self = current_task->id;
  world_.checks().release(self, sync);
  if (++state.arrived != state.count) {
    world_.segments().accept_change(&state, sizeof state);
    {
      const GhostScope ghost;
      of.waiting.push_back(self);
    }
    // Afterwards the barrier may be gone.
    world_.scheduler().block(key, VirtualClock::never);
    return 0;
  }
  state.arrived = 0;
  world_.segments().accept_change(&state, sizeof state);
  // All of them now: who goes on late must not come after those who have come for the next round.
  for (const TaskId task : of.waiting) world_.checks().acquire(task, sync);
  world_.checks().acquire(self, sync);
  world_.checks().forget(sync);
  of.waiting.clear();
  world_.scheduler().wake(key, tasks_max);
  return PTHREAD_BARRIER_SERIAL_THREAD;
}

int Barriers::destroy(pthread_barrier_t* barrier) noexcept {
  if (reinterpret_cast<const State*>(barrier)->count == 0) return 0;  // as with glibc
  State& state = resolve(barrier);
  const Barrier& of = barriers_[state.number];
  if (!of.waiting.empty()) {
    const std::string& self = current_task->name;
    const GhostScope ghost;
    world_.scheduler().fail(
        OutcomeKind::assertion,
        fmt::format("{} is destroyed by {} while {} waits at it", world_.objects().object_name(of.object),
                    self, world_.scheduler().task(of.waiting.front()).name));
  }
  std::memset(&state, 0, sizeof state);
  world_.segments().accept_change(&state, sizeof state);
  return 0;
}

bool Barriers::belongs_to_an_execution(const pthread_barrier_t* barrier) noexcept {
  return World::is_execution_number(reinterpret_cast<const State*>(barrier)->execution);
}

std::string Barriers::describe(ObjectId barrier) const {
  for (const Barrier& each : barriers_) {
    if (each.object == barrier) return fmt::format("{} of {} have come", each.waiting.size(), each.count);
  }
  return {};
}

void Barriers::add_state(StateHash& hash) const noexcept {
  hash.add(barriers_.size());
  for (const Barrier& barrier : barriers_) {
    hash.add(std::uint64_t{barrier.object} << 32U | barrier.waiting.size());
    for (const TaskId task : barrier.waiting) hash.add(task);
  }
}

}  // namespace ltsim
