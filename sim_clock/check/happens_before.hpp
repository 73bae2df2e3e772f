// What of one task has happened before where another one stands, for certain: by program order and by what
// synchronises.
//
// Release and acquire are those of the C++ memory model (C++20 [intro.races], [atomics.order],
// [atomics.fences]); semaphores, mutexes and the like are releases and acquires of a key. The clock of a task
// ticks when it releases: what it does later is not covered by what it has handed over.
//
// Differs from C++: an atomic object is known by its first byte alone, so accesses of different widths to
// one place synchronise; and one made anew at the address of another one inherits what that handed over, so
// that a race may stay unseen. No edge is made where C++ has none.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim_clock/check/vector_clocks.hpp"

namespace ltsim {

/// Names what tasks synchronise by; the families do not overlap.
struct SyncKey {
  std::uint64_t value;

  /// @param place  Segments::canonical() of its first byte
  static SyncKey atomic(std::uint64_t place) noexcept { return {place}; }
  static SyncKey futex(std::uint64_t place) noexcept { return {place ^ std::uint64_t{1} << 56U}; }
  static SyncKey once(std::uint64_t place) noexcept { return {place ^ std::uint64_t{2} << 56U}; }
  /// A semaphore, a mutex, a barrier; a lock for readers and writers, as its writers leave it.
  static SyncKey object(std::uint32_t id) noexcept { return {std::uint64_t{3} << 56U | id}; }
  /// A lock for readers and writers, as its readers leave it: to each other they hand over nothing.
  static SyncKey readers(std::uint32_t id) noexcept { return {std::uint64_t{4} << 56U | id}; }
  /// Signals to a process.
  static SyncKey signals(std::uint32_t process) noexcept { return {std::uint64_t{5} << 56U | process}; }
};

enum class AtomicAccess : std::uint8_t { load, store, update };

/// Whether a memory order, one of the __ATOMIC_ macros, has the parts of these names.
[[nodiscard]] bool acquires(int order) noexcept;
[[nodiscard]] bool releases(int order) noexcept;
[[nodiscard]] bool is_seq_cst(int order) noexcept;

/// What a load or the load of an update may receive, and what a store or the store of an update hands over.
[[nodiscard]] constexpr bool reads(AtomicAccess access) noexcept { return access != AtomicAccess::store; }
[[nodiscard]] constexpr bool writes(AtomicAccess access) noexcept { return access != AtomicAccess::load; }

class HappensBefore {
 public:
  HappensBefore();
  void reset() noexcept;

  /// From the next execution on, is_ordered_by_family() is known.
  void follow_family() noexcept { follows_family_ = true; }

  /// A new task, which comes after nothing.
  void begins(TaskId task);
  /// All that `earlier` has done comes before what `later` does from now on: it made the task, it was joined
  /// by it, or it is dead and its death is known.
  void follows(TaskId later, TaskId earlier) noexcept;

  /// Hands over what has happened before; who hands over with the same key later adds to it.
  void release(TaskId task, SyncKey key);
  void acquire(TaskId task, SyncKey key) noexcept;
  /// Nothing of what was handed over can be received any more.
  void forget(SyncKey key) noexcept;

  /// The two halves of an atomic access, which itself lies between them. Either does nothing where the access
  /// has no such half.
  /// @param order  __ATOMIC_RELAXED to __ATOMIC_SEQ_CST
  void before_atomic(TaskId task, SyncKey key, AtomicAccess access, int order);
  void after_atomic(TaskId task, SyncKey key, AtomicAccess access, int order);
  void fence(TaskId task, int order);

  // --- for a memory that keeps more than the latest store of a place (WeakMemory) ---

  /// What one store hands over to the loads that see it.
  using HandedOver = VectorClocks::Row;
  static constexpr HandedOver nothing = ~HandedOver{0};
  /// A store is made. @param continued  of the store that it replaces as an update, whose release sequence it is part of
  [[nodiscard]] HandedOver store_hands_over(TaskId task, int order, HandedOver continued);
  /// A load sees a store.
  void load_receives(TaskId task, HandedOver handed_over, int order) {
    if (handed_over != nothing) receive(tasks_[task], handed_over, order);
  }
  /// Nobody can see that store any more.
  void drop(HandedOver handed_over) {
    if (handed_over != nothing) clocks_.give_back(handed_over);
  }
  /// What is handed over there, by task number.
  [[nodiscard]] const Ticks* covered_by(HandedOver handed_over) const noexcept {
    return clocks_.at(handed_over);
  }

  /// The clock of a task: what it does now is known to those who know at least that much of it.
  [[nodiscard]] Ticks now(TaskId task) const noexcept { return clocks_.at(tasks_[task].now)[task]; }
  /// Whether what `earlier` did at that time of its clock comes before all that `later` does from now on for the only reason that tasks
  /// make others and join them: no schedule has it the other way round.
  [[nodiscard]] bool is_ordered_by_family(TaskId earlier, Ticks ticks, TaskId later) const noexcept {
    return ticks <= clocks_.at(tasks_[later].family)[earlier];
  }
  /// What `task` knows, by task number.
  [[nodiscard]] const Ticks* known_to(TaskId task) const noexcept { return clocks_.at(tasks_[task].now); }

 private:
  using Row = VectorClocks::Row;
  static constexpr Row none = nothing;

  struct TaskClocks {
    Row now = none;       // what happened before its next step
    Row fenced = none;    // what its last release fence covers: later relaxed stores hand that over
    Row received = none;  // what its relaxed loads saw handed over: an acquire fence makes it known
    Row family = none;    // what happened before its next step because tasks were made and joined
  };
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t generation = 0;  // of the execution it belongs to; another one: it is free
    Row row = 0;
  };

  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const noexcept;
  /// @return none if nothing was ever handed over with the key
  [[nodiscard]] Row find(SyncKey key) const noexcept;
  [[nodiscard]] Row find_or_add(SyncKey key);
  void grow();
  void receive(TaskClocks& task, Row handed_over, int order);
  void tick(TaskId task) noexcept { ++clocks_.at(tasks_[task].now)[task]; }

  VectorClocks clocks_;
  std::array<TaskClocks, tasks_max> tasks_;
  std::vector<Slot> slots_;  // open addressing; a power of two of them, at most half used
  std::size_t slots_used_ = 0;
  std::uint32_t generation_ = 0;
  bool follows_family_ = false;
};

}  // namespace ltsim
