// What ends a run, in each step in which it can be: the reason is named, no strobe rises any more, the PLC is reset
// as far as it can be reached, and the next run finds nothing left over.
#include <thread>

#include <gtest/gtest.h>

#include "kernel_mocks/nc_parser.hpp"
#include "tests/kernel_mocks/simulated/simulated_kernel.hpp"

namespace kernel_mocks {
namespace {

/// All events come here, when each step is under way.
constexpr auto event_at = 300ms;
/// Three polls, and what the requests around them cost.
constexpr auto soon = 4ms;

struct Setup {
  TimedPlc& plc;
  LogicTaskOptions& logic;
  OperatorScript& script;
  /// SIGINT, which its own thread takes.
  bool& interrupt;
};

struct Step {
  const char* name;
  const char* program;
  void (*prepare)(const Setup& setup);
  /// The kernel looks at the PLC in this step; in others it sees a fault of it in the next one.
  bool sees_the_plc = true;
};

bool always(std::optional<std::chrono::nanoseconds>) { return true; }

constexpr Step steps[] = {
    {"waits_for_an_old_fin_to_go", "M8\nM9\nM30", [](const Setup& it) { it.plc.fin = always; }},
    {"waits_for_tmf", "M8\nM9\nM30", [](const Setup& it) { it.logic.tmf = 600ms; }, false},
    {"waits_for_fin", "M8\nM9\nM30", [](const Setup& it) { it.plc.durations[8] = 5s; }},
    {"waits_for_tfin", "M8\nM9\nM30", [](const Setup& it) { it.logic.tfin = 5s; }},
    {"waits_for_fin_to_go", "M8\nM9\nM30",
     [](const Setup& it) {
       it.plc.fin = [&plc = it.plc](auto since) { return since || plc.count_of(m_strobe) > 0; };
     }},
    {"moves_at_feed", "G1 X100 F600\nM9\nM30", [](const Setup&) {}},
    {"moves_rapidly", "G0 X500\nM9\nM30", [](const Setup&) {}},
    {"dwells", "G4 P5\nM9\nM30", [](const Setup&) {}},
    {"moves_while_a_function_is_under_way", "M49\nG0 X500\nM9\nM30",
     [](const Setup& it) { it.plc.durations[49] = 5s; }},
    {"waits_for_the_spindle", "S900 M3\nG1 X1 F600\nM9\nM30",
     [](const Setup& it) { it.plc.port.set_bit(123, false); }},
    {"waits_in_a_feed_hold", "G0 X1\nG0 X500\nM9\nM30",
     [](const Setup& it) { it.script.push_back({100ms, OperatorEvent::feed_hold}); }},
    {"waits_between_two_blocks_in_a_feed_hold", "G4 P0.2\nM9\nM30",
     [](const Setup& it) { it.script.push_back({100ms, OperatorEvent::feed_hold}); }},
    {"waits_for_cycle_start_at_m0", "M0\nM9\nM30", [](const Setup&) {}},
};

struct Event {
  const char* name;
  LogicFault fault;
  void (*arm)(const Setup& setup);
  bool comes_from_the_plc = false;
  bool reaches_the_plc = true;
};

constexpr Event events[] = {
    {"reset", LogicFault::operator_reset,
     [](const Setup& it) { it.script.push_back({event_at, OperatorEvent::reset}); }},
    {"abort", LogicFault::operator_abort,
     [](const Setup& it) { it.script.push_back({event_at, OperatorEvent::abort}); }},
    {"emergency_stop", LogicFault::operator_emergency_stop,
     [](const Setup& it) { it.script.push_back({event_at, OperatorEvent::emergency_stop}); }},
    {"interrupt", LogicFault::interrupted, [](const Setup& it) { it.interrupt = true; }},
    {"alarm", LogicFault::alarm, [](const Setup& it) { it.plc.set_later(event_at, 121, true); }, true},
    {"chain_opens", LogicFault::emergency_stop,
     [](const Setup& it) { it.plc.set_later(event_at, 122, false); }, true},
    {"plc_restarts", LogicFault::emergency_stop,
     [](const Setup& it) { it.plc.do_later(event_at, [&plc = it.plc] { plc.port.clear_memory(); }); }, true},
    {"plc_falls_silent", LogicFault::link_lost,
     [](const Setup& it) {
       it.plc.do_later(event_at, [&plc = it.plc] { plc.port.silent_from_request = 1; });
     },
     true, false},
};

class RunEndings : public SimulatedKernel, public testing::WithParamInterface<std::tuple<Step, Event>> {};

TEST_P(RunEndings, names_the_reason_and_leaves_nothing_over) {
  const auto& [step, event] = GetParam();
  const bool unseen = event.comes_from_the_plc && !step.sees_the_plc;
  bool interrupt = false;
  OperatorScript script;
  step.prepare({plc, logic, script, interrupt});
  event.arm({plc, logic, script, interrupt});
  // Somebody is there until the end.
  script.push_back({1h, OperatorEvent::cycle_start});
  ScriptedOperator scripted{script};
  OperatorPanel panel;
  runner.panel = &panel;
  runner.operator_ = &scripted;

  const Program program = parse_program(step.program).value();
  RunResult result;
  RunResult next;
  std::size_t changes = 0;
  in_world([&] {
    std::atomic<bool> stop{false};
    std::thread signal_thread{[&] {
      while (!plc.port.bit(104)) std::this_thread::sleep_for(100us);
      std::this_thread::sleep_for(event_at);
      stop = interrupt;
    }};
    FxDriver driver{plc.port, {.retries = 0}};
    LogicTask logic_task{driver, logic, nullptr, &stop};
    PartProgramRunner part_program{logic_task, runner};
    result = part_program.run(program);
    changes = plc.port.log.size();
    EXPECT_FALSE(plc.port.any_strobe() && event.reaches_the_plc);
    EXPECT_TRUE(plc.port.bit(103) || !event.reaches_the_plc) << "DEN";
    EXPECT_FALSE(plc.port.bit(104) && event.reaches_the_plc) << "program running";
    EXPECT_FALSE(plc.port.bit(106) && event.reaches_the_plc) << "feed hold";
    // All is well again, and the operator has gone.
    signal_thread.join();
    stop = false;
    plc.make_well();
    scripted = ScriptedOperator{{}};
    next = part_program.run(parse_program("M7\nG4 P1\nM30").value());
  });

  ASSERT_TRUE(result.failure.has_value()) << result.message;
  EXPECT_EQ(result.failure->fault, event.fault) << result.message;
  // No function begins after the event, and the reset follows it at once.
  const auto program_start =
      plc.port
          .times[static_cast<std::size_t>(std::ranges::find(plc.port.log, "M104 on") - plc.port.log.begin())];
  std::size_t resets = 0;
  for (std::size_t index = 0; index < changes; ++index) {
    const std::string& change = plc.port.log[index];
    const auto at = plc.port.times[index] - program_start;
    EXPECT_NE(change, "D100 = 9 0 0");
    if (change == m_strobe && !unseen) {
      EXPECT_LE(at, event_at) << "a strobe rose after the event";
    }
    if (change == "M105 on" && at > 0ns) {
      ++resets;
      EXPECT_LE(at, event_at + soon + (unseen ? 300ms : 0ms));
    }
  }
  EXPECT_EQ(resets, event.reaches_the_plc ? 1U : 0U);
  EXPECT_EQ(next.outcome, RunOutcome::ended) << next.message;
}

INSTANTIATE_TEST_SUITE_P(EachStep, RunEndings,
                         testing::Combine(testing::ValuesIn(steps), testing::ValuesIn(events)),
                         [](const auto& instance) {
                           return std::string{std::get<1>(instance.param).name} + "_while_it_" +
                                  std::get<0>(instance.param).name;
                         });

}  // namespace
}  // namespace kernel_mocks
