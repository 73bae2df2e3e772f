#include "sim_clock/explore/schedule.hpp"

#include <gtest/gtest.h>

#include "sim_clock/explore/duration_text.hpp"

namespace ltsim {
namespace {

using namespace std::chrono_literals;

constexpr const char* every_kind_of_line = R"(ltsim schedule 1
scenario  paper/time-out
memory    sc
outcome   invariant: I1: the answer to request 1 was delivered for request 2

# a comment
switch    -                start                                        to emulator/main
switch    kernel/main      before atomic_load segment.state #3          to emulator/main
switch    kernel/main      in sem_wait handoff #1                       to emulator/main
switch    kernel/main      end                                          to emulator/main
time      kernel/main      before clock_read - #2                       +20ms
stall     emulator/main    before atomic_store segment.state #1         +1500us
choose    -                asks delay #1                                7
fault     kernel/main      before sem_post handoff #2                   lost-post 1
crash     kernel/main      before sem_post handoff #3                   of emulator
older     kernel/main      before atomic_load segment.state #4          by 2
)";

TEST(Schedule, reads_every_kind_of_line) {
  const auto schedule = parse_schedule(every_kind_of_line);
  ASSERT_TRUE(schedule) << schedule.error().line << ": " << schedule.error().reason;
  EXPECT_EQ(schedule->scenario, "paper/time-out");
  EXPECT_EQ(schedule->outcome, OutcomeKind::invariant);
  EXPECT_EQ(schedule->message, "I1: the answer to request 1 was delivered for request 2");
  const auto& lines = schedule->deviations;
  ASSERT_EQ(lines.size(), 10U);
  EXPECT_EQ(lines[0].anchor, "- start");
  EXPECT_EQ(lines[1].anchor, "kernel/main before atomic_load segment.state #3");
  EXPECT_EQ(lines[1].to_task, "emulator/main");
  EXPECT_EQ(lines[1].line, 8U);
  EXPECT_EQ(lines[4].kind, Deviation::Kind::pass_time);
  EXPECT_EQ(lines[4].passes, 20ms);
  EXPECT_EQ(lines[5].kind, Deviation::Kind::stall);
  EXPECT_EQ(lines[5].passes, 1500us);
  EXPECT_EQ(lines[6].kind, Deviation::Kind::choose);
  EXPECT_EQ(lines[6].answer, 7U);
  EXPECT_EQ(lines[7].kind, Deviation::Kind::fault);
  EXPECT_EQ(lines[7].fault, FaultKind::lost_post);
  EXPECT_EQ(lines[7].answer, 1U);
  EXPECT_EQ(lines[8].kind, Deviation::Kind::fault);
  EXPECT_EQ(lines[8].fault, FaultKind::crash);
  EXPECT_EQ(lines[8].anchor, "kernel/main before sem_post handoff #3");
  EXPECT_EQ(lines[8].process, "emulator");
  EXPECT_EQ(lines[9].kind, Deviation::Kind::older);
  EXPECT_EQ(lines[9].answer, 2U);
}

TEST(Schedule, what_was_written_reads_back_equal) {
  const auto schedule = parse_schedule(every_kind_of_line);
  ASSERT_TRUE(schedule);
  const auto again = parse_schedule(to_string(*schedule));
  ASSERT_TRUE(again) << again.error().reason;
  EXPECT_EQ(again->deviations, schedule->deviations);
  EXPECT_EQ(again->scenario, schedule->scenario);
  EXPECT_EQ(again->message, schedule->message);
}

TEST(Schedule, carriage_returns_end_a_line_however_many_there_are) {
  const auto schedule =
      parse_schedule("ltsim schedule 1\r\r\nscenario a/b\r\r\noutcome invariant: late\r\r\n");
  ASSERT_TRUE(schedule);
  EXPECT_EQ(schedule->scenario, "a/b");
  EXPECT_EQ(schedule->message, "late");
}

TEST(Schedule, an_input_is_written_and_read_record_by_record) {
  Schedule schedule;
  schedule.scenario = "fuzz/fx-frame";
  schedule.input = {std::string{"\x02\"10\\F\x03\0\xff", 9}, "M3 S500\n", "", "\r\t # no comment"};
  const std::string text = to_string(schedule);
  EXPECT_NE(text.find("\ninput     \"\\x02\\\"10\\\\F\\x03\\x00\\xff\"\n"), std::string::npos) << text;
  const auto again = parse_schedule(text);
  ASSERT_TRUE(again) << again.error().reason;
  EXPECT_EQ(again->input, schedule.input);
}

TEST(Schedule, an_input_that_is_no_quoted_text_is_refused_with_what_is_wrong) {
  const auto reason = [](const std::string& record) {
    const auto schedule = parse_schedule("ltsim schedule 1\nscenario a/b\ninput " + record + "\n");
    return schedule ? "" : std::to_string(schedule.error().line) + ": " + schedule.error().reason;
  };
  EXPECT_EQ(reason("\"\\x4f\\x4F\""), "");
  for (const char* unquoted : {"", "02", "'a'"})
    EXPECT_EQ(reason(unquoted), "3: the bytes stand in double quotes");
  for (const char* escape : {"\"\\a\"", "\"\\x0\"", "\"\\xg0\"", "\"\\x+1\""})
    EXPECT_EQ(reason(escape).substr(0, 18), "3: behind a backsl") << escape;
  for (const char* end : {"\"a", "\"\\\"", "\"a\"b", "\"a\" \"b\""})
    EXPECT_EQ(reason(end), "3: the bytes end with a double quote, and the line with it") << end;
  EXPECT_EQ(reason("\"\x7f\""), "3: byte 0x7f is to be written as \\x7f");
}

TEST(Schedule, a_carriage_return_within_a_message_that_is_read_is_a_blank) {
  const auto schedule = parse_schedule("ltsim schedule 1\nscenario a/b\noutcome crash: one\rtwo\n");
  ASSERT_TRUE(schedule) << schedule.error().reason;
  EXPECT_EQ(schedule->message, "one two");
}

TEST(Schedule, the_one_processor_of_a_machine_is_written_and_read) {
  Schedule schedule;
  schedule.scenario = "a/b";
  EXPECT_EQ(to_string(schedule).find("cpu"), std::string::npos);
  schedule.cpu = Cpu::one_fifo;
  const auto again = parse_schedule(to_string(schedule));
  ASSERT_TRUE(again) << again.error().reason;
  EXPECT_EQ(again->cpu, Cpu::one_fifo);
}

TEST(Schedule, what_is_no_failure_and_where_an_execution_begins_is_written_and_read) {
  Schedule schedule;
  schedule.scenario = "demo/races";
  EXPECT_EQ(to_string(schedule).find("races"), to_string(schedule).find("demo/races") + 5);
  EXPECT_EQ(to_string(schedule).find("state"), std::string::npos);
  schedule.findings = {.races = false, .leaks = false};
  schedule.start_state = StartState::fork;
  const auto read_back = parse_schedule(to_string(schedule));
  ASSERT_TRUE(read_back) << read_back.error().reason;
  EXPECT_EQ(read_back->findings, schedule.findings);
  EXPECT_EQ(read_back->start_state, StartState::fork);
}

TEST(Schedule, a_message_of_several_lines_is_written_as_one) {
  Schedule schedule{
      .scenario = "a/b", .outcome = OutcomeKind::crash, .message = "one\ntwo", .input = {}, .deviations = {}};
  const auto again = parse_schedule(to_string(schedule));
  ASSERT_TRUE(again) << again.error().reason;
  EXPECT_EQ(again->message, "one two");
}

TEST(Schedule, a_message_reads_back_as_one_line_holds_it) {
  for (const char* const message : {"  indented", "of a foreign system\r", "a\r\nb", "\n", " "}) {
    const Schedule schedule{
        .scenario = "a/b", .outcome = OutcomeKind::crash, .message = message, .input = {}, .deviations = {}};
    const auto again = parse_schedule(to_string(schedule));
    ASSERT_TRUE(again) << again.error().reason;
    EXPECT_EQ(again->message, one_line(message)) << message;
  }
}

struct BadSchedule {
  const char* name;
  const char* text;
  std::size_t line;
  const char* reason_has;

  static std::string name_of(const testing::TestParamInfo<BadSchedule>& tested) { return tested.param.name; }
};

class BadScheduleTest : public testing::TestWithParam<BadSchedule> {};

TEST_P(BadScheduleTest, is_refused_with_its_line_and_the_way_out) {
  const auto schedule = parse_schedule(GetParam().text);
  ASSERT_FALSE(schedule);
  EXPECT_EQ(schedule.error().line, GetParam().line);
  EXPECT_NE(schedule.error().reason.find(GetParam().reason_has), std::string::npos)
      << schedule.error().reason;
}

#define HEAD "ltsim schedule 1\nscenario a/b\n"
INSTANTIATE_TEST_SUITE_P(
    Schedule, BadScheduleTest,
    testing::Values(
        BadSchedule{"empty", "", 1, "ltsim schedule 1"},
        BadSchedule{"foreign_file", "{\"json\": 1}\n", 1, "ltsim schedule 1"},
        BadSchedule{"later_version", "ltsim schedule 2\n", 1, "ltsim schedule 1"},
        BadSchedule{"no_scenario", "ltsim schedule 1\nmemory sc\n", 2, "which scenario"},
        BadSchedule{"unknown_word", HEAD "swich a to b\n", 3, "swich"},
        BadSchedule{"unknown_outcome", HEAD "outcome lost\n", 3, "lost"},
        BadSchedule{"unknown_cpu", HEAD "cpu two\n", 3, "one-fifo"},
        BadSchedule{"unknown_memory", HEAD "memory tso\n", 3, "c11"},
        BadSchedule{"older_by_nothing", HEAD "older a/b before read x #1 by 0\n", 3, "by COUNT"},
        BadSchedule{"older_without_by", HEAD "older a/b before read x #1 2\n", 3, "by COUNT"},
        BadSchedule{"switch_to_nowhere", HEAD "switch a/b before read x #1\n", 3, "switch TASK before"},
        BadSchedule{"no_occurrence", HEAD "switch a/b before read x to c/d\n", 3, "#N"},
        BadSchedule{"bad_occurrence", HEAD "switch a/b before read x #1x to c/d\n", 3, "#N"},
        BadSchedule{"no_duration", HEAD "time a/b before read x #1 20\n", 3, "+20ms"},
        BadSchedule{"negative_duration", HEAD "time a/b before read x #1 +-20ms\n", 3, "+20ms"},
        BadSchedule{"huge_duration", HEAD "stall a/b before read x #1 +9223372036854775807s\n", 3, "+20ms"},
        BadSchedule{"answer_is_no_number", HEAD "choose a/b asks x #1 many\n", 3, "number"},
        BadSchedule{"crash_of_nobody", HEAD "crash a/b before read x #1\n", 3, "of PROCESS"},
        BadSchedule{"crash_by_number", HEAD "fault a/b before read x #1 crash 1\n", 3, "kind of fault"},
        BadSchedule{"lone_word", HEAD "switch\n", 3, "switch TASK before"}),
    BadSchedule::name_of);

TEST(DurationText, is_exact_and_short) {
  EXPECT_EQ(to_text(20ms), "20ms");
  EXPECT_EQ(to_text(1500us), "1500us");
  EXPECT_EQ(to_text(2s), "2s");
  EXPECT_EQ(to_text(1ns), "1ns");
  EXPECT_EQ(parse_duration("20ms"), 20ms);
  EXPECT_EQ(parse_duration("ms"), std::nullopt);
  EXPECT_EQ(parse_duration("20"), std::nullopt);
  EXPECT_EQ(parse_duration("20 ms"), std::nullopt);
}

}  // namespace
}  // namespace ltsim
