// What the operator's buttons and switches do to a program that runs.
#include "kernel_mocks/nc_parser.hpp"
#include "tests/kernel_mocks/simulated/simulated_kernel.hpp"

namespace kernel_mocks {
namespace {

class OperatorEvents : public SimulatedKernel {
 protected:
  OperatorEvents() { runner.panel = &panel_; }

  RunResult run_with(std::string_view program, OperatorScript script) {
    ScriptedOperator scripted{std::move(script)};
    runner.operator_ = &scripted;
    return run_program(program);
  }

 private:
  OperatorPanel panel_;
};

TEST_F(OperatorEvents, a_program_stop_waits_for_cycle_start) {
  ASSERT_EQ(run_with("M0\nM9\nM30", {{700ms, OperatorEvent::cycle_start}}).outcome, RunOutcome::ended);
  EXPECT_GE(plc.time_of("D100 = 9 0 0"), 700ms);
  EXPECT_LT(plc.time_of("D100 = 9 0 0"), 702ms);
}

TEST_F(OperatorEvents, a_cycle_start_before_the_stop_is_not_kept_for_it) {
  const RunResult result = run_with("G4 P0.5\nM0\nM30", {{100ms, OperatorEvent::cycle_start}});
  EXPECT_EQ(result.outcome, RunOutcome::stopped);
}

TEST_F(OperatorEvents, a_program_stop_ends_the_run_when_the_operator_has_left) {
  const RunResult result = run_with("M0\nM30", {{300ms, OperatorEvent::optional_stop_on}});
  EXPECT_EQ(result.outcome, RunOutcome::stopped);
  EXPECT_EQ(result.message, "line 1: program stop");
  EXPECT_GE(plc.time_of("M105 on"), 300ms);
}

TEST_F(OperatorEvents, so_does_a_feed_hold_and_its_signal_goes_off) {
  const RunResult result = run_with("G4 P0.5\nN20 M9\nM30", {{100ms, OperatorEvent::feed_hold}});
  EXPECT_EQ(result.outcome, RunOutcome::stopped);
  EXPECT_EQ(result.message, "block N20 (line 2): feed hold");
  EXPECT_FALSE(plc.port.bit(106));
}

TEST_F(OperatorEvents, the_switch_of_m1_can_be_turned_while_the_program_runs) {
  EXPECT_EQ(run_with("N10 M1\nN20 M30", {{std::uint32_t{10}, OperatorEvent::optional_stop_on}}).message,
            "block N10 (line 1): program stop");
  runner.optional_stop = true;
  EXPECT_EQ(run_with("N10 M1\nN20 M30", {{std::uint32_t{10}, OperatorEvent::optional_stop_off}}).outcome,
            RunOutcome::ended);
}

TEST_F(OperatorEvents, a_feed_hold_at_a_block_holds_that_block) {
  ASSERT_EQ(run_with("N10 M8\nN20 M9\nM30",
                     {{std::uint32_t{20}, OperatorEvent::feed_hold}, {900ms, OperatorEvent::cycle_start}})
                .outcome,
            RunOutcome::ended);
  EXPECT_LT(plc.time_of("D100 = 8 0 0"), 10ms);
  EXPECT_GE(plc.time_of("D100 = 9 0 0"), 900ms);
}

TEST_F(OperatorEvents, plc_stop_is_m8037_and_plc_run_first_m8035_then_m8036) {
  ASSERT_EQ(
      run_with("G4 P1\nM30", {{100ms, OperatorEvent::plc_stop}, {500ms, OperatorEvent::plc_run}}).outcome,
      RunOutcome::ended);
  EXPECT_GE(plc.time_of("M8037 on"), 100ms);
  EXPECT_GE(plc.time_of("M8035 on"), 500ms);
  EXPECT_GE(plc.time_of("M8036 on"), plc.time_of("M8035 on"));
}

TEST_F(OperatorEvents, an_operator_by_chance_may_hold_a_program_and_never_for_ever) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    plc.port.log.clear();
    plc.port.times.clear();
    RandomOperator chance{{OperatorEvent::feed_hold, OperatorEvent::optional_stop_on},
                          50ms,
                          [state = seed](std::uint32_t bound) mutable {
                            state = state * 1664525U + 1013904223U;
                            return (state >> 16U) % bound;
                          }};
    runner.operator_ = &chance;
    EXPECT_EQ(run_program("M8 G0 X20\nM1\nG1 X0 F6000 M9\nM0\nM30").outcome, RunOutcome::ended) << seed;
  }
}

/// The observer is told of each function's begin, then of its end, whatever ends the run.
class EachOnce final : public PartProgramObserver {
 public:
  void given(const Block&, const FunctionRequest& request, TimePoint) noexcept override {
    if (under_way) broken = true;
    under_way = true;
    events.push_back("given " + to_string(request));
  }
  void acknowledged(const Block&, const FunctionRequest& request,
                    std::chrono::nanoseconds) noexcept override {
    ended("done " + to_string(request));
  }
  void not_acknowledged(const Block&, const FunctionRequest& request, const LogicFailure&) noexcept override {
    ended("not done " + to_string(request));
  }
  std::vector<std::string> events;
  bool under_way = false;
  bool broken = false;

 private:
  void ended(std::string what) {
    if (!under_way) broken = true;
    under_way = false;
    events.push_back(std::move(what));
  }
};

using Log = std::vector<std::string>;

TEST_F(OperatorEvents, a_function_under_way_at_a_reset_is_told_of_as_not_done) {
  EachOnce told;
  observer = &told;
  plc.durations[49] = 5s;
  run_with("M49\nG0 X500\nM30", {{300ms, OperatorEvent::reset}});
  EXPECT_EQ(told.events, (Log{"given M49", "not done M49"}));
}

TEST_F(OperatorEvents, a_function_that_ended_unseen_before_a_reset_is_told_of_as_done) {
  EachOnce told;
  observer = &told;
  plc.durations[49] = 100ms;
  run_with("M49\nG0 X500\nM30", {{300ms, OperatorEvent::reset}});
  EXPECT_EQ(told.events, (Log{"given M49", "done M49"}));
}

TEST_F(OperatorEvents, at_a_reset_in_whatever_moment_each_function_begins_and_ends_once_for_the_observer) {
  const Program program = parse_program("M8\nM49 G0 X1\nM10 M7 G1 X0 F600\nM9\nM30").value();
  logic.fin_timeout = logic.ready_timeout = logic.status_age_max = 1h;
  std::optional<TimedPlc> fresh;
  const ltsim::Outcome outcome = run_randomly(300, [&](ltsim::World& world) {
    fresh.emplace();
    for (const std::uint16_t m : {std::uint16_t{8}, std::uint16_t{49}, std::uint16_t{7}}) {
      fresh->durations[m] = 10ms;
    }
    world.process("kernel").start("main", [&, &world = world] {
      EachOnce told;
      OperatorPanel panel;
      ScriptedOperator scripted{{{40ms, OperatorEvent::reset}}};
      RunnerOptions options;
      options.panel = &panel;
      options.operator_ = &scripted;
      FxDriver driver{fresh->port, {.retries = 0}};
      LogicTask logic_task{driver, logic};
      const RunResult result = PartProgramRunner{logic_task, options, &told}.run(program);
      world.require(result.failure && result.failure->fault == LogicFault::operator_reset, result.message);
      world.require(!told.broken && !told.under_way, "begin and end by turns");
      world.require(!fresh->port.any_strobe(), "no strobe is left");
    });
  });
  EXPECT_EQ(outcome, ltsim::Outcome{});
}

}  // namespace
}  // namespace kernel_mocks
