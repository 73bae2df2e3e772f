// The single total order S of all seq_cst operations (C++20 [atomics.order], as P0668R5 states it), kept as what it must respect:
// an operation that would put one before itself is not possible.
//
// S is not the order in which operations are carried out here: where nothing but a relaxed load has told of a
// seq_cst store, a later operation may still come before it. So each event has the set of those that must precede it, and
// a load that sees an older store, or a store that takes a place before another, adds to them.
//
// The 63 latest events are told apart. What is older is one event, the past, which precedes all others: so some orders
// that C++ allows are not seen in executions with more of them; none is seen that it forbids.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "sim_clock/check/vector_clocks.hpp"

namespace ltsim {

class SeqCstOrder {
 public:
  /// Bit = number of an event.
  using Events = std::uint64_t;
  static constexpr std::size_t events_max = 64;

  void reset() noexcept {
    count_ = 1;
    fences_ = 0;
    before_[0] = 0;
  }

  /// Whether shorten() must come before the next add().
  [[nodiscard]] bool is_full() const noexcept { return count_ == events_max; }
  /// The older half becomes part of the past. All sets of events that are kept must be shortened().
  void shorten() noexcept;
  [[nodiscard]] static constexpr Events shortened(Events events) noexcept {
    constexpr Events old = (Events{1} << 32U) - 1;
    return ((events >> 31U) & ~Events{1}) | Events{(events & old) != 0};
  }

  /// Those that strongly happen before what `task` does next, and what must precede them.
  /// @param known  what happens before it, by task
  [[nodiscard]] Events before_next_of(TaskId task, const Ticks* known) const noexcept;
  /// Fences that happen before something, or are what `task` has done itself.
  /// @param more  a second row of what happens before it; may be null
  [[nodiscard]] Events fences_before(TaskId task, const Ticks* known, const Ticks* more) const noexcept;
  /// The events and all that must precede one of them.
  [[nodiscard]] Events with_predecessors(Events events) const noexcept {
    Events all = events;
    for (; events != 0; events &= events - 1)
      all |= before_[static_cast<std::size_t>(std::countr_zero(events))];
    return all;
  }

  struct Ticked {
    Ticks happens;           ///< who knows that much of the task comes after the event
    Ticks strongly_happens;  ///< and who knows that much, strongly so
  };
  /// @param before  with their predecessors
  /// @return        the new event alone
  Events add(TaskId task, Ticked ticks, bool is_fence, Events before) noexcept;
  /// Puts `earlier`, which holds its predecessors, before each of `later`. That must not make a circle.
  void put_before(Events earlier, Events later) noexcept;

 private:
  std::size_t count_ = 1;  // the first is the past
  Events fences_ = 0;
  std::array<Events, events_max> before_{};
  std::array<Ticked, events_max> ticks_{};
  std::array<TaskId, events_max> tasks_{};
};

}  // namespace ltsim
