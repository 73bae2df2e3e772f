// A schedule file: whatever the text, it is refused with a line of it, or what it says prints and parses to the same; and any
// bytes at all can be quoted.

#include <string>

#include "fuzz/text_input.hpp"
#include "sim_clock/explore/quoted_bytes.hpp"
#include "sim_clock/explore/schedule.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

using ltsim::expect;

bool are_equal(const ltsim::Schedule& one, const ltsim::Schedule& other) {
  return one.scenario == other.scenario && one.outcome == other.outcome && one.message == other.message &&
         one.cpu == other.cpu && one.input == other.input && one.deviations == other.deviations;
}

void check_quoted(std::string_view bytes) {
  const auto again = ltsim::parse_quoted(ltsim::quoted(bytes));
  expect(again && *again == bytes, "bytes that are quoted read as themselves");
  const auto read = ltsim::parse_quoted(bytes);
  expect(!read || ltsim::parse_quoted(ltsim::quoted(*read)) == *read,
         "what was quoted otherwise reads as itself");
}

}  // namespace

FUZZ_TARGET("schedule-file", {}, "the text of a schedule: parsed, printed and parsed again") {
  const std::string_view text = fuzz::text_of(input);
  check_quoted(text);
  const auto schedule = ltsim::parse_schedule(text);
  if (!schedule) {
    expect(fuzz::line_of(text, schedule.error().line).has_value(), "a refusal names a line of the file");
    expect(!schedule.error().reason.empty(), "a refusal has a reason");
    return;
  }
  for (const ltsim::Deviation& deviation : schedule->deviations)
    expect(fuzz::line_of(text, deviation.line).has_value(), "a choice comes from a line of the file");
  const std::string printed = to_string(*schedule);
  const auto again = ltsim::parse_schedule(printed);
  expect(again && are_equal(*again, *schedule), "a schedule that is printed reads as itself");
  expect(to_string(*again) == printed, "equal schedules are printed alike");
}
