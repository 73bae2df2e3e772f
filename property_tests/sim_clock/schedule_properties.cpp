// Schedule files: what is printed reads back equal, whatever it holds.

#include <algorithm>
#include <ostream>

#include "property_tests/support/property.hpp"
#include "sim_clock/explore/duration_text.hpp"
#include "sim_clock/explore/quoted_bytes.hpp"
#include "sim_clock/explore/schedule.hpp"

namespace ltsim {

void showValue(const Schedule& schedule, std::ostream& out) { out << to_string(schedule); }

}  // namespace ltsim

namespace property_tests {
namespace {

using namespace ltsim;

/// Of a task, an object, a scenario: any characters but blanks.
rc::Gen<std::string> any_word() {
  return rc::gen::nonEmpty(rc::gen::container<std::string>(
      rc::gen::oneOf(rc::gen::inRange('!', '\x7f'), rc::gen::elementOf(std::string{"abz/.-_#019"}))));
}

std::string numbered(const std::string& words) {
  return words + " #" + std::to_string(*rc::gen::arbitrary<unsigned>());
}

std::string any_anchor() {
  const std::string task = *any_word();
  switch (*rc::gen::inRange(0, 5)) {
    case 0:
      return "- start";
    case 1:
      return task + " end";
    case 2:
      return numbered(task + " asks " + *any_word());
    default:
      return numbered(task + *rc::gen::element<std::string>(" before ", " in ") + *any_word() + ' ' +
                      *any_word());
  }
}

SimTime any_duration() {
  const SimTime unit{*rc::gen::element<std::int64_t>(1, 1'000, 1'000'000, 1'000'000'000)};
  return unit * *rc::gen::inRange<std::int64_t>(0, SimTime::max() / unit);
}

rc::Gen<Deviation> any_deviation() {
  return rc::gen::exec([] {
    Deviation deviation;
    using enum Deviation::Kind;
    deviation.kind = *rc::gen::element(switch_task, pass_time, stall, fault, choose);
    deviation.anchor = any_anchor();
    if (deviation.kind == switch_task) deviation.to_task = *any_word();
    if (deviation.kind == pass_time || deviation.kind == stall) deviation.passes = any_duration();
    if (deviation.kind == choose) deviation.answer = *rc::gen::arbitrary<std::size_t>();
    if (deviation.kind != fault) return deviation;
    deviation.fault = static_cast<FaultKind>(*rc::gen::inRange<std::size_t>(0, fault_kinds_count));
    if (deviation.fault == FaultKind::crash)
      deviation.process = *any_word();
    else
      deviation.answer = *rc::gen::inRange<std::size_t>(1, 100);
    return deviation;
  });
}

rc::Gen<Schedule> any_schedule() {
  return rc::gen::exec([] {
    Schedule schedule;
    schedule.scenario = *any_word();
    schedule.outcome =
        static_cast<OutcomeKind>(*rc::gen::inRange(0, static_cast<int>(OutcomeKind::unsupported) + 1));
    schedule.message = *rc::gen::arbitrary<std::string>();
    schedule.cpu = *rc::gen::element(Cpu::many, Cpu::one_fifo);
    schedule.input = *rc::gen::arbitrary<std::vector<std::string>>();
    schedule.deviations = *rc::gen::container<std::vector<Deviation>>(any_deviation());
    return schedule;
  });
}

void assert_equal(const Schedule& one, const Schedule& other) {
  RC_ASSERT(one.scenario == other.scenario);
  RC_ASSERT(to_string(one.outcome) == to_string(other.outcome));
  RC_ASSERT(one.message == other.message);
  RC_ASSERT((one.cpu == other.cpu));
  RC_ASSERT(one.input == other.input);
  RC_ASSERT((one.deviations == other.deviations));
}

// Of the message only what a line can hold.
PROPERTY(Schedule, that_was_printed_reads_back_equal, ()) {
  Schedule schedule = *any_schedule();
  const auto again = parse_schedule(to_string(schedule));
  if (!again) RC_FAIL(std::to_string(again.error().line) + ": " + again.error().reason);
  schedule.message = one_line(schedule.message);
  assert_equal(*again, schedule);
}

// Damage makes a line that is refused, or one that means something and is kept.
PROPERTY(Schedule, damaged_by_hand_is_refused_or_means_what_it_prints, ()) {
  std::string text = to_string(*any_schedule());
  for (int i = *rc::gen::inRange(1, 4); i > 0; --i) {
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    switch (*rc::gen::inRange(0, 3)) {
      case 0:
        text.erase(at, *rc::gen::inRange<std::size_t>(1, 12));
        break;
      case 1:
        text.insert(at, *rc::gen::element<std::string>(" ", "\n", "\"", "#", "\\x", "\r\n", "switch ", "0"));
        break;
      default:
        text[at] = *rc::gen::arbitrary<char>();
    }
    if (text.empty()) return;
  }
  auto schedule = parse_schedule(text);
  if (!schedule) {
    RC_ASSERT(!schedule.error().reason.empty());
    RC_ASSERT(schedule.error().line >= 1U);
    RC_ASSERT(schedule.error().line <= static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1);
    return;
  }
  const auto again = parse_schedule(to_string(*schedule));
  if (!again) RC_FAIL(again.error().reason);
  schedule->message = one_line(schedule->message);
  assert_equal(*again, *schedule);
}

PROPERTY(QuotedBytes, are_one_line_of_ascii_and_read_back_equal, (const std::string& bytes)) {
  const std::string text = ltsim::quoted(bytes);
  RC_ASSERT(std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; }));
  const auto again = parse_quoted(text);
  RC_ASSERT(again.has_value());
  RC_ASSERT(*again == bytes);
}

PROPERTY(QuotedBytes, that_somebody_typed_are_refused_or_stand_for_what_they_print, ()) {
  const auto pieces = *rc::gen::container<std::vector<std::string>>(rc::gen::element<std::string>(
      "\"", "\\", "\\x", "0", "f", "F", "\\n", "n", " ", "\\\"", "\\x41", "\t", "\xff"));
  std::string text = "\"";
  for (const std::string& piece : pieces) text += piece;
  text += '"';
  const auto bytes = parse_quoted(text);
  if (!bytes) return;
  RC_ASSERT(parse_quoted(ltsim::quoted(*bytes)) == *bytes);
  RC_ASSERT(bytes->size() <= text.size() - 2);
}

PROPERTY(DurationText, is_exact, ()) {
  const SimTime duration = any_duration();
  RC_ASSERT(parse_duration(to_text(duration)) == duration);
}

}  // namespace
}  // namespace property_tests
