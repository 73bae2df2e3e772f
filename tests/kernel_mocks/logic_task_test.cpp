// The handshake of the logic task, step by step, against a PLC whose every scan the test decides.
#include "kernel_mocks/logic_task.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/kernel_mocks/scripted_plc.hpp"

namespace kernel_mocks {
namespace {

using namespace std::chrono_literals;
using Log = std::vector<std::string>;

FunctionRequest m3_s500() { return {.m = std::uint16_t{3}, .s = std::uint16_t{500}, .t = {}}; }

class Recorder final : public LogicTaskObserver {
 public:
  void strobe_raised(FunctionKind kind, std::uint16_t number) noexcept override {
    events.push_back(fmt::format("raised {}{}", letter(kind), number));
  }
  void finished(FunctionKind kind, std::uint16_t number,
                std::chrono::nanoseconds duration) noexcept override {
    events.push_back(fmt::format("finished {}{}", letter(kind), number));
    durations.push_back(duration);
  }
  Log events;
  std::vector<std::chrono::nanoseconds> durations;

 private:
  static char letter(FunctionKind kind) {
    return kind == FunctionKind::m ? 'M' : kind == FunctionKind::s ? 'S' : 'T';
  }
};

class LogicTaskTest : public testing::Test {
 protected:
  LogicTaskTest() {
    // Waits that succeed have ample time; a test of a time-out shortens the one it is about.
    options = {.poll_interval = 1us, .fin_timeout = 60s, .ready_timeout = 60s, .reset_pulse = 1us};
  }

  ScriptedPlc plc;
  FxDriver driver{plc, {.answer_timeout = 10s, .retries = 0}};
  LogicTaskOptions options;
  Recorder recorder;
  std::atomic<bool> stop{false};

  LogicTask task() { return LogicTask{driver, options, &recorder, &stop}; }
};

TEST_F(LogicTaskTest, writes_the_values_then_raises_the_strobes_and_lowers_them_after_fin) {
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  EXPECT_TRUE(plc.bit(100));
  EXPECT_TRUE(plc.bit(101));
  EXPECT_FALSE(plc.bit(102));
  ASSERT_TRUE(logic.acknowledge().has_value());
  EXPECT_EQ(plc.log, (Log{"D100 = 3 500 0", "M96 byte B0", "M96 byte 80"}));
}

TEST_F(LogicTaskTest, raises_all_strobes_of_a_request_with_one_write) {
  LogicTask logic = task();
  ASSERT_TRUE(
      logic.raise({.m = std::uint16_t{6}, .s = std::uint16_t{900}, .t = std::uint16_t{5}}).has_value());
  EXPECT_EQ(plc.log, (Log{"D100 = 6 900 5", "M96 byte F0"}));
}

TEST_F(LogicTaskTest, keeps_speed_and_tool_number_but_not_the_m_code) {
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  ASSERT_TRUE(logic.acknowledge().has_value());
  ASSERT_TRUE(logic.raise({.m = {}, .s = {}, .t = std::uint16_t{7}}).has_value());
  EXPECT_EQ(plc.log.at(3), "D100 = 0 500 7");
}

TEST_F(LogicTaskTest, waits_for_fin_to_come) {
  plc.scan = [](ScriptedPlc& it) { it.set_bit(120, it.any_strobe() && it.polls >= 20); };
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  ASSERT_TRUE(logic.acknowledge().has_value());
  EXPECT_GE(plc.polls, 20U);
}

TEST_F(LogicTaskTest, waits_for_fin_to_go_before_it_is_done) {
  // FIN lags ten polls behind the strobes.
  unsigned fin_since = 0;
  plc.scan = [&](ScriptedPlc& it) {
    if (it.any_strobe()) {
      it.set_bit(120, true);
      fin_since = it.polls;
    } else if (it.polls > fin_since + 10) {
      it.set_bit(120, false);
    }
  };
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  ASSERT_TRUE(logic.acknowledge().has_value());
  EXPECT_FALSE(plc.bit(120));
}

TEST_F(LogicTaskTest, ignores_a_fin_that_is_on_before_the_strobe_until_it_has_gone) {
  plc.set_bit(120, true);
  bool strobe_met_stale_fin = false;
  plc.scan = [&](ScriptedPlc& it) {
    if (it.polls == 5) it.set_bit(120, false);
    if (it.any_strobe() && it.polls < 5) strobe_met_stale_fin = true;
    if (it.polls > 8 && it.any_strobe()) it.set_bit(120, true);
    if (it.polls > 8 && !it.any_strobe()) it.set_bit(120, false);
  };
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  ASSERT_TRUE(logic.acknowledge().has_value());
  EXPECT_FALSE(strobe_met_stale_fin);
  EXPECT_GT(plc.polls, 8U);
}

TEST_F(LogicTaskTest, a_fin_that_never_goes_before_the_strobe_is_a_fault_and_no_strobe_rises) {
  options.fin_timeout = 1ms;
  plc.set_bit(120, true);
  plc.scan = [](ScriptedPlc&) {};
  LogicTask logic = task();
  EXPECT_EQ(logic.raise(m3_s500()).error().fault, LogicFault::fin_stuck);
  EXPECT_TRUE(plc.log.empty());
}

TEST_F(LogicTaskTest, a_fin_that_never_comes_is_a_fault_after_its_time_and_not_before) {
  options.fin_timeout = 2ms;
  plc.scan = [](ScriptedPlc&) {};
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  const auto done = logic.acknowledge();
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().fault, LogicFault::fin_missing);
  EXPECT_GE(done.error().after, 2ms);
}

TEST_F(LogicTaskTest, a_fin_that_stays_after_the_strobe_has_fallen_is_a_fault) {
  plc.scan = [](ScriptedPlc& it) {
    if (it.any_strobe()) it.set_bit(120, true);
  };
  options.fin_timeout = 1ms;
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  EXPECT_EQ(logic.acknowledge().error().fault, LogicFault::fin_stuck);
}

TEST_F(LogicTaskTest, an_alarm_in_mid_wait_ends_it_with_the_alarm_number) {
  plc.scan = [](ScriptedPlc& it) {
    if (it.polls < 5) return;
    it.set_bit(121, true);
    it.set_word(120, 17);
  };
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  const auto done = logic.acknowledge();
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().fault, LogicFault::alarm);
  EXPECT_EQ(done.error().alarm_number, 17);
}

TEST_F(LogicTaskTest, an_alarm_counts_even_when_fin_comes_with_it) {
  plc.scan = [](ScriptedPlc& it) {
    if (!it.any_strobe()) return;
    it.set_bit(120, true);
    it.set_bit(121, true);
  };
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  EXPECT_EQ(logic.acknowledge().error().fault, LogicFault::alarm);
}

TEST_F(LogicTaskTest, an_open_emergency_stop_chain_ends_the_wait) {
  plc.scan = [](ScriptedPlc& it) {
    if (it.polls == 5) it.set_bit(122, false);
  };
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  EXPECT_EQ(logic.acknowledge().error().fault, LogicFault::emergency_stop);
}

TEST_F(LogicTaskTest, a_plc_that_restarts_with_cleared_memory_ends_the_wait) {
  plc.scan = [](ScriptedPlc& it) {
    if (it.polls == 5) it.clear_memory();
  };
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  EXPECT_EQ(logic.acknowledge().error().fault, LogicFault::emergency_stop);
}

TEST_F(LogicTaskTest, a_plc_that_falls_silent_in_mid_wait_is_a_lost_link) {
  plc.scan = [](ScriptedPlc&) {};
  plc.silent_from_request = 8;
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  const auto done = logic.acknowledge();
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().fault, LogicFault::link_lost);
  EXPECT_EQ(done.error().link, FxDriverError::no_answer);
}

TEST_F(LogicTaskTest, the_link_may_be_lost_at_every_request_of_a_handshake) {
  // poll, values, strobes, poll, strobes, poll: six requests when FIN comes at once.
  std::size_t broken = 1;
  for (;; ++broken) {
    ScriptedPlc fresh;
    fresh.silent_from_request = broken;
    FxDriver link{fresh, {.answer_timeout = 10s, .retries = 0}};
    LogicTask logic{link, options};
    const auto raised = logic.raise(m3_s500());
    if (!raised) {
      EXPECT_EQ(raised.error().fault, LogicFault::link_lost);
      continue;
    }
    const auto done = logic.acknowledge();
    if (done) break;
    EXPECT_EQ(done.error().fault, LogicFault::link_lost);
  }
  EXPECT_EQ(broken, 7U);
}

TEST_F(LogicTaskTest, a_request_to_stop_ends_the_wait) {
  plc.scan = [this](ScriptedPlc& it) {
    if (it.polls == 5) stop = true;
  };
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  EXPECT_EQ(logic.acknowledge().error().fault, LogicFault::interrupted);
}

TEST_F(LogicTaskTest, the_observer_sees_each_function_with_its_duration) {
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise({.m = std::uint16_t{6}, .s = {}, .t = std::uint16_t{5}}).has_value());
  const auto duration = logic.acknowledge();
  ASSERT_TRUE(duration.has_value());
  EXPECT_EQ(recorder.events, (Log{"raised M6", "raised T5", "finished M6", "finished T5"}));
  EXPECT_EQ(recorder.durations, (std::vector{*duration, *duration}));
}

TEST_F(LogicTaskTest, the_observer_is_not_told_of_a_finish_that_did_not_come) {
  options.fin_timeout = 1ms;
  plc.scan = [](ScriptedPlc&) {};
  LogicTask logic = task();
  ASSERT_TRUE(logic.raise(m3_s500()).has_value());
  ASSERT_FALSE(logic.acknowledge().has_value());
  EXPECT_EQ(recorder.events, (Log{"raised M3", "raised S500"}));
}

TEST_F(LogicTaskTest, a_program_begins_with_a_reset_and_ends_with_running_off) {
  LogicTask logic = task();
  ASSERT_TRUE(logic.begin_program().has_value());
  EXPECT_EQ(plc.log,
            (Log{"M96 byte 80", "D100 = 0", "M105 on", "M105 off", "M104 off", "M106 off", "M104 on"}));
  ASSERT_TRUE(logic.end_program().has_value());
  EXPECT_EQ(plc.log.back(), "M104 off");
}

TEST_F(LogicTaskTest, a_program_begins_on_top_of_strobes_that_a_dead_kernel_left_behind) {
  plc.set_bit(100, true);
  plc.set_bit(105, true);
  LogicTask logic = task();
  ASSERT_TRUE(logic.begin_program().has_value());
  EXPECT_FALSE(plc.any_strobe());
  EXPECT_FALSE(plc.bit(105));
}

TEST_F(LogicTaskTest, a_program_begins_when_the_plc_has_become_ready) {
  plc.set_bit(121, true);
  plc.set_bit(126, false);
  plc.scan = [](ScriptedPlc& it) {
    if (it.polls == 5) it.set_bit(121, false);
    if (it.polls == 9) it.set_bit(126, true);
  };
  LogicTask logic = task();
  EXPECT_TRUE(logic.begin_program().has_value());
  EXPECT_GE(plc.polls, 9U);
}

TEST_F(LogicTaskTest, a_program_does_not_begin_with_an_alarm_an_open_chain_or_without_cycle_start_enable) {
  options.ready_timeout = 1ms;
  LogicTask logic = task();
  plc.set_bit(126, false);
  EXPECT_EQ(logic.begin_program().error().fault, LogicFault::not_ready);
  plc.set_bit(121, true);
  EXPECT_EQ(logic.begin_program().error().fault, LogicFault::alarm);
  plc.set_bit(122, false);
  EXPECT_EQ(logic.begin_program().error().fault, LogicFault::emergency_stop);
  EXPECT_FALSE(plc.bit(104));
}

TEST_F(LogicTaskTest, failures_read_as_sentences) {
  EXPECT_EQ(to_string(LogicFailure{.fault = LogicFault::alarm, .alarm_number = 17, .after = 1500ms}),
            "PLC alarm 17 after 1.50 s");
  EXPECT_EQ(to_string(LogicFailure{.fault = LogicFault::fin_missing, .after = 10s}),
            "no FIN from the PLC within 10.00 s");
  EXPECT_EQ(to_string(LogicFailure{.fault = LogicFault::link_lost, .link = FxDriverError::no_answer}),
            "the link to the PLC failed: the PLC does not answer");
}

}  // namespace
}  // namespace kernel_mocks
