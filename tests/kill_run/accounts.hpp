// Accounts for every request of a run: from what both sides have journalled, and from the kills.
//
// Invariants, numbered as in protocol/README.md and the monitors of the simulated world
//   I1   an answer is delivered for the request it answers, and that request was executed
//   I3   what is executed is a request that was submitted, whole
//   I4   what is delivered is the answer to the request, whole
//   I5   no request is executed twice
//   I6   what the kernel was told is not executed, or rejected, is not: neither before nor after
//   I15  a call ends within its time-outs, and what a busy machine adds
//   I16  nothing is withdrawn or given up before its full time
//   I17  a process that starts can open, and a fresh request after a kill ends ok
//   I18  a request ends exactly once, unless its kernel was killed; as unknown only if it was given up in BUSY, or an
//        emulator was killed meanwhile
// A request counts as executed from the moment in which the emulator journals that it begins.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/kill_run/journal.hpp"
#include "tests/kill_run/run_options.hpp"

namespace kill_run {

enum class Role : std::uint8_t { kernel, emulator };

struct Kill {
  Role role = Role::kernel;
  std::uint32_t incarnation = 0;
  Clock::time_point begin = {};  ///< it was alive until here
  Clock::time_point dead = {};   ///< and not any more from here on
};

struct Evidence {
  std::span<const Entry> kernel;
  std::span<const Entry> emulator;
  std::span<const Kill> kills;  ///< in order of time
};

struct Tally {
  std::uint64_t submitted = 0;
  std::uint64_t executed = 0;
  std::array<std::uint64_t, 4> outcomes = {};  ///< by protocol::ExchangeOutcome
  std::uint64_t without_outcome = 0;           ///< their kernel was killed
  std::uint64_t executed_without_outcome = 0;  ///< of these
  std::uint64_t unknown_but_executed = 0;
  std::uint64_t given_up = 0;
  std::uint64_t withdrawn = 0;
  std::uint64_t closed = 0;  ///< processes that left in good order, and came again
  std::uint64_t fresh = 0;
  std::vector<std::chrono::nanoseconds> usual_calls;  ///< how long they lasted
  std::vector<std::chrono::nanoseconds> fresh_calls;
};

struct Accounts {
  Tally tally;
  /// What does not hold: the invariant, the request, and what went wrong. Empty: every request is accounted for.
  std::vector<std::string> accusations;
};

[[nodiscard]] Accounts account_for(const Evidence& evidence);

}  // namespace kill_run
