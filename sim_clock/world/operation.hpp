// What a task is about to do at a scheduling point.
#pragma once

#include <cstdint>
#include <string_view>

namespace ltsim {

/// The operations of the simulated world that other tasks can notice. The names in to_string() are those of
/// schedule files and traces: a name once published stays.
enum class OperationKind : std::uint8_t {
  read,
  write,
  atomic_load,
  atomic_store,
  atomic_exchange,
  atomic_update,
  sem_open,
  sem_close,
  sem_unlink,
  sem_init,
  sem_destroy,
  sem_wait,
  sem_trywait,
  sem_timedwait,
  sem_post,
  sem_getvalue,
  mutex_lock,
  mutex_trylock,
  mutex_timedlock,
  mutex_unlock,
  cond_wait,
  cond_timedwait,
  cond_signal,
  cond_broadcast,
  futex_wait,
  futex_wake,
  once,
  thread_create,
  thread_join,
  thread_start,
  thread_end,
  shm_open,
  shm_status,
  shm_unlink,
  shm_resize,
  shm_map,
  shm_unmap,
  clock_read,
  sleep,
  yield,
  atomic_fence,
  rwlock_rdlock,
  rwlock_tryrdlock,
  rwlock_timedrdlock,
  rwlock_wrlock,
  rwlock_trywrlock,
  rwlock_timedwrlock,
  rwlock_unlock,
  spin_lock,
  spin_trylock,
  spin_unlock,
  barrier_wait,
  static_init,
  thread_tryjoin,
  thread_timedjoin,
  signal_wait,
  signal_send,
  semop,
  semop_nowait,  // takes, or waits for zero, and does not wait
  semctl,
  semctl_get,
};

[[nodiscard]] std::string_view to_string(OperationKind kind) noexcept;

[[nodiscard]] constexpr bool is_plain_access(OperationKind kind) noexcept {
  return kind == OperationKind::read || kind == OperationKind::write;
}

[[nodiscard]] constexpr bool is_memory_access(OperationKind kind) noexcept {
  return kind <= OperationKind::atomic_update;
}

[[nodiscard]] constexpr bool changes_memory(OperationKind kind) noexcept {
  return is_memory_access(kind) && kind != OperationKind::read && kind != OperationKind::atomic_load;
}

/// Whether a task can do it again and again without anything changing: looking, and trying in vain.
[[nodiscard]] constexpr bool can_be_polling(OperationKind kind) noexcept {
  // Asked at each scheduling point.
  static_assert(static_cast<unsigned>(OperationKind::semctl_get) < 64, "the last kind has a bit, too");
  constexpr std::uint64_t polling = [] {
    std::uint64_t bits = 0;
    for (const OperationKind looks :
         {OperationKind::read, OperationKind::atomic_load,
          OperationKind::atomic_exchange,  // the loop of a spin lock
          OperationKind::sem_open, OperationKind::sem_trywait, OperationKind::sem_getvalue,
          OperationKind::mutex_trylock, OperationKind::shm_open, OperationKind::shm_status,
          OperationKind::clock_read, OperationKind::yield, OperationKind::rwlock_tryrdlock,
          OperationKind::rwlock_trywrlock, OperationKind::spin_lock, OperationKind::spin_trylock,
          OperationKind::thread_tryjoin, OperationKind::semop_nowait, OperationKind::semctl_get}) {
      bits |= std::uint64_t{1} << static_cast<unsigned>(looks);
    }
    return bits;
  }();
  return (polling >> static_cast<unsigned>(kind) & 1) != 0;
}

/// Whether it changes something for other tasks, whatever the state of the world.
[[nodiscard]] bool changes_what_others_see(OperationKind kind) noexcept;

/// Number of a named thing of the world: a semaphore, a segment, a mutex; 0 is "no object".
using ObjectId = std::uint32_t;
/// From here on: memory of a whole program (ProgramMemory).
inline constexpr ObjectId first_program_object = 0xfffff1;

struct Operation {
  OperationKind kind = OperationKind::read;
  std::uint8_t bytes = 0;  ///< of a memory access, 1 to 16
  /// Of what opens or unlinks an object by name, which is not known as one yet: a hash of that name, so that some that have
  /// nothing to do with each other can be told apart; 0 = no name.
  std::uint8_t name = 0;
  bool is_seq_cst : 1 = false;  ///< an atomic operation or a fence of that memory order
  /// Of an access to memory of a whole program: RaceDetector::is_contended().
  bool is_contended : 1 = false;
  ObjectId object = 0;  ///< what it acts on
  /// Of a memory access in a segment: the byte. Of what has no object: the low half of the address, which tells
  /// places apart and means nothing in another run; 0 = nothing in particular.
  std::uint32_t offset = 0;
  /// Of a memory access: where in the program's code, counted from its begin; 0 = not known.
  std::uint32_t site = 0;

  /// Equal as steps, wherever in the code they stand.
  bool operator==(const Operation& other) const noexcept {
    return kind == other.kind && bytes == other.bytes && object == other.object && offset == other.offset;
  }
};

/// Of a POSIX name, with or without its '/', for Operation::name: 1 to 255; 0 of an empty one.
[[nodiscard]] constexpr std::uint8_t name_hash(std::string_view name) noexcept {
  if (name.starts_with('/')) name.remove_prefix(1);
  if (name.empty()) return 0;
  std::uint32_t hash = 2166136261U;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return static_cast<std::uint8_t>(1 + hash % 255);
}

/// Whether the order of the two can matter to anybody: they act on the same thing, and one changes it.
/// Operations that act on nothing in particular (clocks, sleeping) depend on nothing.
[[nodiscard]] bool depend(const Operation& one, const Operation& other) noexcept;

}  // namespace ltsim
