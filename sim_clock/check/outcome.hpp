// How an execution ended.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ltsim {

enum class OutcomeKind : std::uint8_t {
  passed,
  invariant,    ///< a property of the scenario does not hold
  assertion,    ///< the code under test contradicted itself: assert, abort
  deadlock,     ///< no task can run and no timer is armed
  livelock,     ///< more scheduling points than the scenario allows
  data_race,    ///< two accesses to shared memory, one of them a plain one, that nothing orders
  leak,         ///< a lock is held at the end; a block of memory is lost
  crash,        ///< an exception nobody caught, a signal; memory that is not there (any more)
  exit,         ///< a whole program ended with a status other than 0
  unsupported,  ///< a call that the world does not simulate: our limit, not a finding
};

[[nodiscard]] std::string_view to_string(OutcomeKind kind) noexcept;

struct Outcome {
  OutcomeKind kind = OutcomeKind::passed;
  std::string message;

  [[nodiscard]] bool passed() const noexcept { return kind == OutcomeKind::passed; }
  bool operator==(const Outcome&) const = default;
};

/// Which of the outcomes that an execution comes to besides what its code does are failures.
struct Findings {
  bool races = true;  ///< data_race
  bool leaks = true;  ///< leak

  bool operator==(const Findings&) const = default;
};

/// See explore/carried_bytes.hpp.
template <typename Carrier>
void carry(Carrier& carrier, Outcome& outcome) {
  carrier(outcome.kind, outcome.message);
}

}  // namespace ltsim
