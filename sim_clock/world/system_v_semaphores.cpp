#include "sim_clock/world/system_v_semaphores.hpp"

#include <algorithm>
#include <cerrno>

#include <fmt/format.h>

#include "sim_clock/world/object_key.hpp"
#include "sim_clock/world/state_hash.hpp"
#include "sim_clock/world/system_v_keys.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {

int SystemVSemaphores::get(key_t key, int count, int flags) {
  world_.scheduler().point(system_v_operation(OperationKind::sem_open, world_, key));
  const GhostScope ghost;
  const SystemVFound found = find_by_key(sets_, key, flags);
  const bool fits =
      found.index ? count >= 0 && static_cast<std::size_t>(count) <= sets_[*found.index].semaphores.size()
                  : count > 0 && count <= semaphores_max;
  if (found.error != 0 || !fits) {
    errno = found.error != 0 ? found.error : EINVAL;
    return -1;
  }
  if (found.index) {
    world_.scheduler().only_looked();
    return static_cast<int>(*found.index);
  }
  const std::string name = name_by_key("sem", sets_, key);
  Set& set = sets_.emplace_back();
  set.key = key;
  set.object = world_.objects().add(name);
  for (int i = 0; i < count; ++i)
    set.semaphores.push_back({.object = world_.objects().add(fmt::format("{}[{}]", name, i))});
  return static_cast<int>(sets_.size() - 1);
}

int SystemVSemaphores::operate(int id, std::span<const sembuf> operations, const timespec* within) {
  if (operations.empty() || operations.size() > operations_max) {
    errno = operations.empty() ? EINVAL : E2BIG;
    return -1;
  }
  if (within != nullptr && (within->tv_sec < 0 || within->tv_nsec < 0 || within->tv_nsec >= 1'000'000'000)) {
    errno = EINVAL;
    return -1;
  }
  Set* set = find(id);
  if (set == nullptr) return -1;
  const bool only_tries = std::all_of(operations.begin(), operations.end(), [](const sembuf& each) {
    return each.sem_op <= 0 && (each.sem_flg & IPC_NOWAIT) != 0;
  });
  world_.scheduler().point(
      {.kind = only_tries ? OperationKind::semop_nowait : OperationKind::semop, .object = set->object});
  // Other tasks run while this one stands at a point or waits: what was found before may have moved.
  set = find(id);
  if (set == nullptr) {
    errno = EIDRM;
    return -1;
  }
  const Deadline deadline = deadline_in(within);
  while (true) {
    const Attempt made = attempt(*set, operations);
    if (made.error != 0) {
      if (made.error == EAGAIN) world_.scheduler().only_looked();
      errno = made.error;
      return -1;
    }
    if (!made.waits_for) return 0;
    if (world_.faults().strikes(FaultKind::interrupt)) [[unlikely]] {
      errno = EINTR;
      return -1;
    }
    const TaskId task = current_task->id;
    {
      const GhostScope ghost;
      set->waiting.emplace_back(task, *made.waits_for);
    }
    const auto woken = world_.scheduler().block(object_key(set->object, true), deadline);
    set = &sets_[static_cast<std::size_t>(id)];
    std::erase_if(set->waiting, [&](const auto& each) { return each.first == task; });
    if (set->removed) {
      errno = EIDRM;
      return -1;
    }
    if (woken != Scheduler::Wake::timed_out) continue;
    const Attempt last = attempt(*set, operations);
    if (last.error == 0 && !last.waits_for) return 0;
    errno = last.error == 0 ? EAGAIN : last.error;
    return -1;
  }
}

SystemVSemaphores::Attempt SystemVSemaphores::attempt(Set& set, std::span<const sembuf> operations) {
  const auto stop_before = [&](std::size_t count, Attempt why) {
    for (const sembuf& made : operations.first(count)) set.semaphores[made.sem_num].value -= made.sem_op;
    return why;
  };
  for (std::size_t i = 0; i < operations.size(); ++i) {
    const sembuf& each = operations[i];
    if (each.sem_num >= set.semaphores.size()) return stop_before(i, {.error = EFBIG});
    int& value = set.semaphores[each.sem_num].value;
    const bool waits = each.sem_op == 0 ? value != 0 : value + each.sem_op < 0;
    if (waits && (each.sem_flg & IPC_NOWAIT) != 0) return stop_before(i, {.error = EAGAIN});
    if (waits) return stop_before(i, {.waits_for = each});
    if (value + each.sem_op > value_max) return stop_before(i, {.error = ERANGE});
    value += each.sem_op;
  }
  bool any_change = false;
  for (const sembuf& each : operations) {
    order(set.semaphores[each.sem_num], each.sem_op);
    set.semaphores[each.sem_num].last_process = current_task->process;
    any_change = any_change || each.sem_op != 0;
    if ((each.sem_flg & SEM_UNDO) != 0 && each.sem_op != 0)
      add_undo(set, current_task->process, each.sem_num, -each.sem_op);
  }
  if (any_change) changed(set);
  return {};
}

void SystemVSemaphores::order(const Semaphore& semaphore, int change) {
  // Who takes comes after who has given, not after others who have taken; who has waited for zero, after these.
  const SyncKey given = SyncKey::object(semaphore.object);
  const SyncKey taken = SyncKey::readers(semaphore.object);
  if (change > 0) world_.checks().release(current_task->id, given);
  if (change < 0) {
    world_.checks().acquire(current_task->id, given);
    world_.checks().release(current_task->id, taken);
    // Nothing is left of what was given so far: no later take can come from it.
    if (semaphore.value == 0) world_.checks().forget(given);
  }
  if (change == 0) world_.checks().acquire(current_task->id, taken);
}

int SystemVSemaphores::control(int id, int number, int command, Argument argument) {
  Set* set = find(id);
  if (set == nullptr) return -1;
  const bool asks_of_one = command == GETVAL || command == GETPID || command == GETNCNT || command == GETZCNT;
  const bool only_asks = asks_of_one || command == GETALL || command == IPC_STAT;
  world_.scheduler().point(
      {.kind = only_asks ? OperationKind::semctl_get : OperationKind::semctl, .object = set->object});
  set = find(id);  // it may have gone, or moved, meanwhile
  if (set == nullptr) return -1;
  if ((asks_of_one || command == SETVAL) &&
      (number < 0 || static_cast<std::size_t>(number) >= set->semaphores.size())) {
    errno = EINVAL;
    return -1;
  }
  const auto is_value = [](int value) { return value >= 0 && value <= value_max; };
  const auto assign = [&](std::size_t index, int value) {
    Semaphore& semaphore = set->semaphores[index];
    semaphore.value = value;
    semaphore.last_process = current_task->process;
    world_.checks().release(current_task->id, SyncKey::object(semaphore.object));
    world_.checks().release(current_task->id, SyncKey::readers(semaphore.object));
    std::erase_if(set->undos, [&](const Undo& each) { return each.number == index; });
  };
  switch (command) {
    case GETVAL:
      return set->semaphores[static_cast<std::size_t>(number)].value;
    case GETPID:
      return world_.system_id(set->semaphores[static_cast<std::size_t>(number)].last_process);
    case GETNCNT:
      return count_waiting(*set, number, false);
    case GETZCNT:
      return count_waiting(*set, number, true);
    case GETALL:
      for (std::size_t i = 0; i < set->semaphores.size(); ++i)
        argument.values[i] = static_cast<unsigned short>(set->semaphores[i].value);
      return 0;
    case SETVAL:
      if (!is_value(argument.value)) {
        errno = ERANGE;
        return -1;
      }
      assign(static_cast<std::size_t>(number), argument.value);
      changed(*set);
      return 0;
    case SETALL:
      for (std::size_t i = 0; i < set->semaphores.size(); ++i) {
        if (is_value(argument.values[i])) continue;
        errno = ERANGE;
        return -1;
      }
      for (std::size_t i = 0; i < set->semaphores.size(); ++i) assign(i, argument.values[i]);
      changed(*set);
      return 0;
    case IPC_RMID:
      set->removed = true;
      changed(*set);
      return 0;
    case IPC_STAT:
      *argument.status = {};
      argument.status->sem_perm.__key = set->key;
      argument.status->sem_perm.mode = 0600;
      argument.status->sem_nsems = set->semaphores.size();
      return 0;
    case IPC_SET:
      return 0;  // the simulated world has one user
    default: {
      const GhostScope ghost;
      world_.unsupported(fmt::format("semctl with command {}", command));
      return -1;
    }
  }
}

void SystemVSemaphores::process_died(ProcessId process) {
  for (Set& set : sets_) {
    bool any = false;
    for (const Undo& undo : set.undos) {
      if (undo.process != process) continue;
      Semaphore& semaphore = set.semaphores[undo.number];
      semaphore.value = std::clamp(semaphore.value + undo.adjustment, 0, value_max);
      for (std::size_t i = 0; i < world_.scheduler().tasks_count(); ++i) {
        const Task& task = world_.scheduler().task(static_cast<TaskId>(i));
        if (task.process != process) continue;
        world_.checks().release(task.id, SyncKey::object(semaphore.object));
        world_.checks().release(task.id, SyncKey::readers(semaphore.object));
      }
      any = true;
    }
    std::erase_if(set.undos, [&](const Undo& each) { return each.process == process; });
    std::erase_if(set.waiting,
                  [&](const auto& each) { return world_.scheduler().task(each.first).process == process; });
    if (any) changed(set);
  }
}

SystemVSemaphores::Set* SystemVSemaphores::find(int id) {
  const auto index = static_cast<std::size_t>(id);
  if (id < 0 || index >= sets_.size() || sets_[index].removed) {
    errno = EINVAL;
    return nullptr;
  }
  return &sets_[index];
}

Deadline SystemVSemaphores::deadline_in(const timespec* within) const noexcept {
  if (within == nullptr) return VirtualClock::never;
  const SimTime now = world_.now();
  const std::chrono::seconds seconds{within->tv_sec};
  constexpr SimTime longest = VirtualClock::never / 2;
  if (seconds > longest - std::chrono::seconds{1} || now > longest) return VirtualClock::never;
  return now + seconds + std::chrono::nanoseconds{within->tv_nsec};
}

void SystemVSemaphores::add_undo(Set& set, ProcessId process, unsigned short number, int adjustment) {
  const auto undo = std::find_if(set.undos.begin(), set.undos.end(), [&](const Undo& each) {
    return each.process == process && each.number == number;
  });
  const GhostScope ghost;
  if (undo != set.undos.end())
    undo->adjustment += adjustment;
  else
    set.undos.push_back({.process = process, .number = number, .adjustment = adjustment});
}

void SystemVSemaphores::changed(const Set& set) {
  world_.scheduler().wake(object_key(set.object, true), tasks_max);
}

int SystemVSemaphores::count_waiting(const Set& set, int number, bool for_zero) const noexcept {
  return static_cast<int>(std::count_if(set.waiting.begin(), set.waiting.end(), [&](const auto& each) {
    return each.second.sem_num == number && (each.second.sem_op == 0) == for_zero;
  }));
}

void SystemVSemaphores::add_state(StateHash& hash) const noexcept {
  hash.add(sets_.size());
  for (const Set& set : sets_) {
    hash.add(std::uint64_t{set.object} << 1U | std::uint64_t{set.removed});
    for (const Semaphore& each : set.semaphores)
      hash.add(static_cast<std::uint64_t>(each.value) << 32U | each.last_process);
    for (const Undo& each : set.undos)
      hash.add(std::uint64_t{each.process} << 48U | std::uint64_t{each.number} << 32U |
               static_cast<std::uint32_t>(each.adjustment));
  }
}

}  // namespace ltsim
