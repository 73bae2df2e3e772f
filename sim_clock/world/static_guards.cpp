#include "sim_clock/world/static_guards.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sim_clock/world/object_key.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

/// What compilers look at, by an atomic load, before they call.
std::uint8_t* first_byte(std::uint64_t* guard) noexcept { return reinterpret_cast<std::uint8_t*>(guard); }

SyncKey sync_key(const std::uint64_t* guard) noexcept { return SyncKey::atomic(Segments::canonical(guard)); }

}  // namespace

StaticGuards::Initialisation* StaticGuards::find(const std::uint64_t* guard) noexcept {
  const auto address = reinterpret_cast<std::uintptr_t>(guard);
  const auto found = std::find_if(initialisations_.begin(), initialisations_.end(),
                                  [address](const Initialisation& each) { return each.guard == address; });
  return found == initialisations_.end() ? nullptr : &*found;
}

bool StaticGuards::acquire(std::uint64_t* guard) noexcept {
  while (*first_byte(guard) == 0) {
    Initialisation* const under_way = find(guard);
    if (under_way == nullptr) {
      // Who gave it up may have begun it.
      world_.checks().acquire(current_task->id, sync_key(guard));
      const Task& self = *current_task;
      const GhostScope ghost;
      initialisations_.push_back(
          {.guard = reinterpret_cast<std::uintptr_t>(guard), .task = self.id, .object = 0});
      return true;
    }
    if (under_way->task == current_task->id) {
      const std::string& self = current_task->name;
      const GhostScope ghost;
      world_.scheduler().fail(OutcomeKind::deadlock,
                              fmt::format("{} needs a static variable that it is initialising itself", self));
    }
    if (under_way->object == 0) {
      const GhostScope ghost;
      under_way->object = world_.objects().add(fmt::format("static-{}", ++named_count_));
    }
    const ObjectId object = under_way->object;
    world_.scheduler().point({.kind = OperationKind::static_init, .object = object});
    const Initialisation* const still = find(guard);
    if (still != nullptr && still->object == object)
      world_.scheduler().block(object_key(object, true), VirtualClock::never);
  }
  world_.checks().acquire(current_task->id, sync_key(guard));
  return false;
}

void StaticGuards::release(std::uint64_t* guard) noexcept {
  if (world_.weak_memory().on()) {
    // Others may go on to see that it is not there, and will call.
    static_cast<void>(world_.weak_memory().access({.address = first_byte(guard),
                                                   .bytes = 1,
                                                   .kind = AtomicAccess::store,
                                                   .order = __ATOMIC_RELEASE,
                                                   .expected = {},
                                                   .operand = 1}));
  }
  *first_byte(guard) = 1;
  world_.checks().release(current_task->id, sync_key(guard));
  end(guard);
}

void StaticGuards::give_up(std::uint64_t* guard) noexcept {
  world_.checks().release(current_task->id, sync_key(guard));
  end(guard);
}

void StaticGuards::end(const std::uint64_t* guard) noexcept {
  const Initialisation* const ended = find(guard);
  if (ended == nullptr) return;  // begun where nobody looked
  const ObjectId object = ended->object;
  {
    const GhostScope ghost;
    initialisations_.erase(initialisations_.begin() + (ended - initialisations_.data()));
  }
  if (object != 0) world_.scheduler().wake(object_key(object, true), tasks_max);
}

const Task* StaticGuards::owner_of(ObjectId variable) const noexcept {
  for (const Initialisation& each : initialisations_) {
    if (each.object == variable) return &world_.scheduler().task(each.task);
  }
  return nullptr;
}

void StaticGuards::add_state(StateHash& hash) const noexcept {
  hash.add(std::uint64_t{initialisations_.size()} << 32U | named_count_);
  for (const Initialisation& each : initialisations_) {
    hash.add(each.guard);
    hash.add(std::uint64_t{each.object} << 32U | each.task);
  }
}

}  // namespace ltsim
