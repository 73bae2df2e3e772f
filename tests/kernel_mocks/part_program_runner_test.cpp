// A whole part program against an obedient PLC, and against one that is not.
#include "kernel_mocks/part_program_runner.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kernel_mocks/nc_parser.hpp"
#include "tests/kernel_mocks/scripted_plc.hpp"

namespace kernel_mocks {
namespace {

using namespace std::chrono_literals;
using Log = std::vector<std::string>;

class Recorder final : public PartProgramObserver {
 public:
  void moved(const Block& block, MotionKind, std::chrono::nanoseconds, bool reached) noexcept override {
    events.push_back(name_of(block) + (reached ? " motion" : " motion cut short"));
  }
  void acknowledged(const Block& block, const FunctionRequest& request,
                    std::chrono::nanoseconds) noexcept override {
    events.push_back(name_of(block) + " " + to_string(request));
  }
  void stop_passed(const Block& block) noexcept override { events.push_back(name_of(block) + " passed"); }
  Log events;
};

class PartProgramRunnerTest : public testing::Test {
 protected:
  RunResult run(const std::string& text, RunnerOptions runner_options = {}) {
    const auto program = parse_program(text);
    EXPECT_TRUE(program.has_value()) << text;
    FxDriver driver{plc, {.answer_timeout = 10s, .retries = 0}};
    LogicTask logic{driver, options};
    return PartProgramRunner{logic, runner_options, &recorder}.run(*program);
  }

  ScriptedPlc plc;
  LogicTaskOptions options{
      .poll_interval = 1us, .fin_timeout = 60s, .ready_timeout = 60s, .reset_pulse = 1us};
  Recorder recorder;
};

TEST_F(PartProgramRunnerTest, runs_functions_and_motion_in_their_order) {
  const auto result = run("N10 T5 M6\nN20 G0 X1 S1500 M3\nN30 G1 X2 F100 M5\nN40 M30");
  EXPECT_EQ(result.outcome, RunOutcome::ended) << result.message;
  EXPECT_EQ(recorder.events,
            (Log{"N10 M6 T5", "N20 M3 S1500", "N20 motion", "N30 motion", "N30 M5", "N40 M30"}));
  EXPECT_FALSE(plc.bit(104));
}

TEST_F(PartProgramRunnerTest, program_running_is_on_while_it_runs) {
  plc.scan = [](ScriptedPlc& it) {
    ScriptedPlc::obey(it);
    EXPECT_TRUE(it.bit(104) || !it.any_strobe());
  };
  EXPECT_EQ(run("M3\nM30").outcome, RunOutcome::ended);
}

TEST_F(PartProgramRunnerTest, the_closing_percent_sign_ends_the_program_too) {
  EXPECT_EQ(run("%\nM3\n%").outcome, RunOutcome::ended);
}

TEST_F(PartProgramRunnerTest, m99_ends_a_main_program_without_the_plc) {
  EXPECT_EQ(run("M3\nM99").outcome, RunOutcome::ended);
  EXPECT_EQ(recorder.events, (Log{"line 1 M3"}));
}

TEST_F(PartProgramRunnerTest, m0_ends_the_run_and_resets_the_plc) {
  const auto result = run("N10 M3\nN20 M0\nN30 M5\nN40 M30");
  EXPECT_EQ(result.outcome, RunOutcome::stopped);
  EXPECT_EQ(result.message, "block N20 (line 2): program stop");
  EXPECT_EQ(recorder.events, (Log{"N10 M3", "N20 M0"}));
  EXPECT_EQ(plc.log.back(), "M104 off");
  EXPECT_EQ(std::ranges::count(plc.log, "M105 on"), 2);
}

TEST_F(PartProgramRunnerTest, m0_goes_on_when_told_to) {
  EXPECT_EQ(run("N10 M0\nN20 M5\nN30 M30", {.continue_at_stop = true}).outcome, RunOutcome::ended);
  EXPECT_EQ(recorder.events, (Log{"N10 M0", "N10 passed", "N20 M5", "N30 M30"}));
}

TEST_F(PartProgramRunnerTest, m1_does_nothing_while_its_switch_is_off) {
  EXPECT_EQ(run("N10 M1 M5\nN20 M30").outcome, RunOutcome::ended);
  EXPECT_EQ(recorder.events, (Log{"N10 M5", "N20 M30"}));
}

TEST_F(PartProgramRunnerTest, m1_stops_while_its_switch_is_on) {
  EXPECT_EQ(run("N10 M1\nN20 M30", {.optional_stop = true}).outcome, RunOutcome::stopped);
  EXPECT_EQ(recorder.events, (Log{"N10 M1"}));
}

TEST_F(PartProgramRunnerTest, a_word_that_does_not_fit_the_plc_is_refused_before_anything_is_sent) {
  const auto result = run("M3 S100\nS70000\nM30");
  EXPECT_EQ(result.outcome, RunOutcome::refused);
  EXPECT_EQ(result.message, "line 2, word 'S70000': the PLC takes whole numbers from 0 to 65535");
  EXPECT_TRUE(plc.log.empty());
}

TEST_F(PartProgramRunnerTest, an_alarm_stops_the_program_names_block_function_and_number_and_resets) {
  plc.scan = [](ScriptedPlc& it) {
    ScriptedPlc::obey(it);
    if (it.word(100) == 8 && it.any_strobe()) {
      it.set_bit(121, true);
      it.set_word(120, 17);
    }
  };
  const auto result = run("N10 M3\nN20 M8\nN30 M30");
  EXPECT_EQ(result.outcome, RunOutcome::failed);
  EXPECT_EQ(result.message.substr(0, result.message.find(" after")), "block N20 (line 2), M8: PLC alarm 17");
  ASSERT_TRUE(result.failure.has_value());
  EXPECT_EQ(result.failure->alarm_number, 17);
  EXPECT_EQ(Log(plc.log.end() - 5, plc.log.end()),
            (Log{"M96 byte 80", "D100 = 0", "M105 on", "M105 off", "M104 off"}));
}

TEST_F(PartProgramRunnerTest, a_missing_fin_stops_the_program_and_names_the_function) {
  plc.scan = [](ScriptedPlc& it) { it.set_bit(120, it.any_strobe() && it.word(100) != 6); };
  options.fin_timeout = 2ms;
  const auto result = run("N10 M3\nN20 T5 M6\nN30 M30");
  EXPECT_EQ(result.outcome, RunOutcome::failed);
  EXPECT_TRUE(result.message.starts_with("block N20 (line 2), M6 T5: no FIN from the PLC within 0.0"))
      << result.message;
  EXPECT_FALSE(plc.any_strobe());
}

TEST_F(PartProgramRunnerTest, a_function_that_is_not_waited_for_lets_the_motion_go_on) {
  EXPECT_EQ(run("N10 M49 G0 X1\nN20 M3\nN30 M30").outcome, RunOutcome::ended);
  EXPECT_EQ(recorder.events, (Log{"N10 motion", "N10 M49", "N20 M3", "N30 M30"}));
}

TEST_F(PartProgramRunnerTest, a_function_that_is_not_waited_for_is_acknowledged_before_the_program_ends) {
  EXPECT_EQ(run("%\nN10 M48\n%").outcome, RunOutcome::ended);
  EXPECT_EQ(recorder.events, (Log{"N10 M48"}));
  EXPECT_FALSE(plc.any_strobe());
}

TEST_F(PartProgramRunnerTest, a_plc_that_is_not_ready_is_reported_as_such) {
  plc.set_bit(126, false);
  options.ready_timeout = 1ms;
  const auto result = run("M30");
  EXPECT_EQ(result.outcome, RunOutcome::failed);
  EXPECT_TRUE(result.message.starts_with("program start: the PLC does not enable the cycle start"))
      << result.message;
}

}  // namespace
}  // namespace kernel_mocks
