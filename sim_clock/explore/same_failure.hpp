// When two failures are one.
//
// Outcome and message tell failures apart. Messages often hold numbers that change with the schedule ("request
// 2", "after 1534us"), and then one bug would be told again and again. So messages that differ in numbers only are
// one failure, unless their minimal schedules need different means: one a switch, say, where the other
// needs a lost post. If one needs what the other does and something more (the bug comes about a request later),
// they are one.
// Two bugs with one message are one failure: a message is the name of what broke.
#pragma once

#include <string>
#include <string_view>

#include "sim_clock/check/outcome.hpp"
#include "sim_clock/explore/schedule.hpp"

namespace ltsim {

struct Failure;

/// Whether the outcome is the one that the schedule records: kind and message equal, as a file holds them.
[[nodiscard]] bool same_failure(const Outcome& outcome, const Schedule& schedule);

/// The same, but for numbers that stand alone: "request 2 took 1534us" is like "request 3 took 12us". Numbers
/// that are part of a word tell things apart: "I1:", "mutex-2", "handoff.cpp:88".
[[nodiscard]] bool alike_failure(const Outcome& outcome, const Schedule& schedule);

/// Whether the message was seen with this failure, or differs from those seen in numbers only and so many of them
/// were seen that one more is no news.
[[nodiscard]] bool is_known_message(const Failure& failure, std::string_view message);

/// Whether the two are one, as told above.
[[nodiscard]] bool is_same_failure(const Failure& one, const Failure& other);

/// The message with each number that stands alone replaced by '#'.
[[nodiscard]] std::string without_numbers(std::string_view message);

}  // namespace ltsim
