// Atomic memory as C++20 allows it to be seen (Memory::c11): every store that some task may still see is kept, in the
// modification order of its location, and which one a load sees is a choice.
//
// A load may see any store that is not older than one that happens before the load, or that the task, or somebody who
// happens before it, has seen ([intro.races]/14 to 18); a store may take any place after those. What a store with a
// release hands over, a release sequence, fences: HappensBefore. seq_cst: SeqCstOrder. An update reads the store right before its
// own. Memory itself holds the last store of each modification order: what is not atomic sees that, and races are reported.
//
// The default, age 0, is the latest store, so an execution without deviations is a sequentially consistent one.
//
// Differs from C++20
//   - A load does not see a store that is carried out after it in the same execution: no load buffering ([atomics.order]/8 asks
//     implementations to forbid the worst of it).
//   - After 64 loads in a row that saw the same older store, a task sees the latest.
//   - Of one location the 64 latest stores are kept.
//   - A store that is not atomic ends the history of its location, and everybody sees it.
//   - Two sizes at overlapping addresses are refused.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim_clock/check/happens_before.hpp"
#include "sim_clock/world/segments.hpp"
#include "sim_clock/world/seq_cst_order.hpp"
#include "sim_clock/world/task.hpp"
#include "sim_clock/world/watched_accesses.hpp"

namespace ltsim {

class WeakMemory {
 public:
  static constexpr std::uint32_t same_older_store_max = 64;
  static constexpr std::size_t stores_max = 64;

  /// An atomic operation of the running task, which has passed its scheduling point.
  struct Access {
    const volatile void* address;
    std::uint8_t bytes;  ///< 1, 2, 4 or 8
    AtomicAccess kind;
    int order;
    int failure_order = __ATOMIC_RELAXED;   ///< of a compare-and-exchange that fails
    std::optional<std::uint64_t> expected;  ///< an update that does nothing unless it finds this
    std::uint64_t operand = 0;              ///< a store: what is stored
    /// An update: what it makes of what it found and of `operand`; bits above its size do not matter.
    std::uint64_t (*change)(std::uint64_t found, std::uint64_t operand) = nullptr;
  };
  struct Result {
    std::uint64_t found;  ///< by a load or an update
    bool stored;
    Ticks ticks;  ///< of the task: what a store hands over covers them
  };

  explicit WeakMemory(World& world) : world_(world), slots_(slots_at_first) {}
  void reset() noexcept;
  /// In this execution memory is weak. Before the first task begins.
  void turn_on() noexcept {
    on_ = true;
    watch_all_writes(true);
  }
  [[nodiscard]] bool on() const noexcept { return on_; }

  Result access(const Access& access);
  void fence(TaskId task, int order);
  /// Bytes are about to be written by something that is not atomic.
  void written_plainly(const volatile void* address, std::size_t bytes) noexcept {
    if (on_ && locations_count_ != 0) forget_history(address, bytes);
  }
  /// The process of the task has died before: whatever was stored then can be seen by its next life.
  void starts_again(TaskId task) noexcept { began_after_[task] = stores_ever_; }

 private:
  using Events = SeqCstOrder::Events;

  struct Store {
    std::uint64_t value = 0;
    std::uint64_t number = 0;  // in the order of execution
    TaskId writer = VirtualClock::no_task;
    HappensBefore::HandedOver handed_over = HappensBefore::nothing;
    bool is_update = false;  // reads the store before it: nothing comes between
    // Sets of events of the seq_cst order: itself if it is one, and fences before it; the same of the loads that saw it; and
    // what must come after whatever comes before this store: itself, those loads, fences after it.
    Events of_store = 0;
    Events of_loads = 0;
    Events after = 0;
  };
  /// A task has seen or made a store when its clock stood there: who knows that much of it sees nothing older.
  struct Seen {
    TaskId task;
    Ticks ticks;
    std::uint32_t position;
    std::uint32_t loads_in_a_row;  // of that store
  };
  struct Location {
    std::uint64_t key = 0;
    std::uint8_t bytes = 0;
    bool was_written_plainly = false;
    Events dropped = 0;         // the events of stores that are not kept any more
    std::vector<Store> stores;  // in modification order
    std::vector<Seen> seen;
  };
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t generation = 0;
    std::uint32_t location = 0;
  };
  /// A store that a load can see, or before which (or at the end) a store can take its place.
  struct Option {
    std::uint32_t age;  // how many stores are newer
    bool stores;
    int order;      // of the operation, as what it turns out to be
    Events before;  // in the seq_cst order, with predecessors
    Events fences;  // that happen before the access
  };

  static constexpr std::size_t slots_at_first = 256;
  static constexpr std::size_t filter_bits = 4096;

  [[nodiscard]] Location& location_of(const Access& access);
  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const noexcept;
  [[nodiscard]] Location* find(std::uint64_t key) noexcept;
  Location& add_location(const Access& access, std::uint64_t key);
  void grow();
  void begin_history(Location& location, std::uint64_t value);
  void forget_history(const volatile void* address, std::size_t bytes) noexcept;
  [[nodiscard]] static std::size_t filter_bit(std::uint64_t key) noexcept {
    return (key / 8 * 0x9e3779b97f4a7c15U) >> 52U;
  }

  /// The oldest store that the task may still see.
  [[nodiscard]] std::uint32_t oldest_visible(const Location& location, TaskId task) const noexcept;
  void list_options(const Location& location, const Access& access, TaskId task);
  /// @return nothing if the access cannot see, or take its place after, the store at `position`
  [[nodiscard]] std::optional<Option> option_at(const Location& location, const Access& access, TaskId task,
                                                std::uint32_t position, Events later) const noexcept;
  [[nodiscard]] Result carry_out(Location& location, const Access& access, TaskId task, const Option& option);
  void see(Location& location, TaskId task, Ticks ticks, std::uint32_t position, bool is_load);
  void insert(Location& location, std::uint32_t position, const Store& store);
  void drop_oldest(Location& location);
  /// Makes room for one more event.
  void make_room_for_event() noexcept;

  World& world_;
  bool on_ = false;
  std::vector<Location> locations_;  // pooled; the first locations_count_ belong to this execution
  std::size_t locations_count_ = 0;
  std::vector<Slot> slots_;  // open addressing; a power of two of them, at most half used
  std::uint32_t generation_ = 1;
  std::array<std::uint64_t, filter_bits / 64> may_hold_location_{};  // by filter_bit()
  SeqCstOrder seq_cst_;
  std::uint64_t stores_ever_ = 1;
  std::array<std::uint64_t, tasks_max> began_after_{};
  std::vector<Option> options_;
  std::vector<std::uint32_t> ages_;
};

}  // namespace ltsim
