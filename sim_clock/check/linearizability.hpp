// Whether a history of overlapping operations could have come from doing them one after the other.
//
// J. Wing, C. Gong, "Testing and verifying concurrent objects" (1993), with the memory of G. Lowe, "Testing for
// linearizability" (2017): a search over orders that respect real time, which never looks twice at the same
// (set of operations done so far, state). Histories are recorded, split by key and told by History
// (history.hpp); here operations and states are numbers only.
//
// An operation that has not returned may have taken effect at any time after its call, or not at all: so it is
// with a time-out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>

namespace ltsim {

/// When an operation was called and when it returned, in numbered events of the history.
struct OperationInterval {
  static constexpr std::uint32_t never = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t called_at = 0;
  std::uint32_t returned_at = never;
};

enum class Linearizability : std::uint8_t {
  linearizable,
  not_linearizable,
  not_decided,  ///< the search was ended by its limit
};

struct LinearizabilityResult {
  Linearizability verdict = Linearizability::linearizable;
  std::uint64_t configurations = 0;  ///< distinct (set of operations done, state) looked at
};

/// States of the sequential object, numbered by the caller; equal states have equal numbers.
using StateNumber = std::uint32_t;

/// One step of the sequential object.
/// @param operation  index
/// @param returned   whether its result counts; of one that has not returned any result is allowed
/// @return           the next state; nothing if the object cannot do this from `state`
using SequentialStep =
    std::function<std::optional<StateNumber>(StateNumber state, std::size_t operation, bool returned)>;

/// Judges the part of a history before event `events_end`; what is called later is left out, and what returns
/// later has not returned.
/// @param operations  in the order of their calls
/// @param initial     state before the first operation
[[nodiscard]] LinearizabilityResult check_linearizability(std::span<const OperationInterval> operations,
                                                          std::uint32_t events_end, StateNumber initial,
                                                          const SequentialStep& step,
                                                          std::uint64_t configurations_max);

}  // namespace ltsim
