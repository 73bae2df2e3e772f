// One cycle: watchdog, overrun, faults from the program and from other cycles, and how they are cleared.
#include <gtest/gtest.h>

#include "tests/emulator_models/soft_plc/scan_task_fixture.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

// I3
TEST_F(ScanTaskTest, watchdog_finds_150_ms_normal_and_a_nanosecond_more_a_fault) {
  ScanTask task = running({.period = 1s});
  rig.duration_of(ScanAction::execute) = 150ms;
  EXPECT_EQ(scan(task), run_scan);
  EXPECT_FALSE(task.fault());
  rig.duration_of(ScanAction::execute) += 1ns;
  EXPECT_EQ(scan(task), "AIFXSL");
  EXPECT_EQ(task.fault(), (Fault{FaultCode::watchdog, ScanAction::execute, 3, 150ms + 1ns}));
}

TEST_F(ScanTaskTest, watchdog_bites_during_an_endless_loop_at_the_end_of_the_slice) {
  ScanTask task = running({.period = 10ms});
  rig.slices_per_scan = 1'000'000'000;
  rig.duration_of(ScanAction::execute) = 100us;
  const std::string calls = scan(task);
  EXPECT_EQ(calls.substr(0, 3), "AIF");
  EXPECT_EQ(calls.substr(3, 1501), std::string(1501, 'X'));
  EXPECT_EQ(calls.substr(1504), "SL");
  EXPECT_EQ(task.fault()->scan_time, 150ms + 100us);
}

TEST_F(ScanTaskTest, watchdog_bites_after_any_step_and_nothing_of_the_scan_follows) {
  const struct {
    ScanAction slow;
    std::string calls;
  } cases[] = {{ScanAction::system_analysis, "ASL"},     {ScanAction::read_inputs, "AISL"},
               {ScanAction::read_from_cycles, "AIFSL"},  {ScanAction::execute, "AIFXSL"},
               {ScanAction::write_to_cycles, "AIFXTSL"}, {ScanAction::write_outputs, "AIFXTGOSL"}};
  for (const auto& [slow, calls] : cases) {
    rig = ScanRig{};
    ScanTask task = running({.period = 10ms, .watchdog_limit = 5ms});
    rig.duration_of(slow) = 6ms;
    EXPECT_EQ(scan(task), calls);
    EXPECT_EQ(task.fault()->code, FaultCode::watchdog);
    EXPECT_EQ(task.fault()->scan_time, 6ms);
    EXPECT_EQ(task.mode(), RunMode::stop);
  }
}

TEST_F(ScanTaskTest, watchdog_measures_the_first_scan_with_its_initialisation) {
  ScanTask task = make({.period = 10ms, .watchdog_limit = 5ms});
  rig.duration_of(ScanAction::initialise) = 6ms;
  ASSERT_TRUE(task.order_run(StartKind::cold));
  EXPECT_EQ(scan(task), "ANSL");
}

TEST_F(ScanTaskTest, watchdog_in_stop_watches_nothing) {
  ScanTask task = make({.period = 10ms, .watchdog_limit = 5ms});
  rig.duration_of(ScanAction::system_analysis) = 20ms;
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_FALSE(task.fault());
}

TEST_F(ScanTaskTest, a_scan_that_was_cut_off_is_not_among_the_scan_times) {
  ScanTask task = running({.period = 10ms, .watchdog_limit = 5ms});
  rig.duration_of(ScanAction::execute) = 6ms;
  scan(task);
  EXPECT_EQ(task.scan_times().scans_count, 1U);
  EXPECT_EQ(task.scan_times().longest, 0ms);
}

// Faults

TEST_F(ScanTaskTest, a_fault_of_the_program_ends_the_scan_at_once) {
  ScanTask task = running({.period = 10ms});
  rig.fails = true;
  EXPECT_EQ(scan(task), "AIFXSL");
  EXPECT_EQ(task.fault(), (Fault{FaultCode::program_failed, ScanAction::execute, 2, 0ms}));
}

TEST_F(ScanTaskTest, run_time_fault_of_the_program_is_named_when_its_slice_also_took_too_long) {
  ScanTask task = running({.period = 10ms, .watchdog_limit = 5ms});
  rig.fails = true;
  rig.duration_of(ScanAction::execute) = 6ms;
  scan(task);
  EXPECT_EQ(task.fault()->code, FaultCode::program_failed);
}

struct FaultedTaskTest : ScanTaskTest {
  FaultedTaskTest() : task{running({.period = 10ms})} {
    rig.fails = true;
    scan(task);
    rig.fails = false;
  }
  ScanTask task;
};

TEST_F(FaultedTaskTest, goes_on_scanning_in_stop_on_its_grid) {
  EXPECT_EQ(task.period().due(), 20ms);
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_EQ(task.period().due(), 40ms);
  EXPECT_EQ(task.period().lost_starts_count(), 0U);
}

// I4
TEST_F(FaultedTaskTest, a_fault_is_cleared_by_reset_and_then_run_and_by_nothing_less) {
  EXPECT_FALSE(task.order_run(StartKind::cold));
  EXPECT_EQ(scan(task), stop_scan);
  task.order_stop();
  EXPECT_FALSE(task.order_run(StartKind::cold));
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_TRUE(task.fault());

  task.order_reset();
  EXPECT_TRUE(task.fault());  // until the next system analysis
  EXPECT_EQ(scan(task), "AlIG");
  EXPECT_FALSE(task.fault());
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_TRUE(task.order_run(StartKind::warm));
  EXPECT_EQ(scan(task), first_run_scan);
}

TEST_F(FaultedTaskTest, reset_and_run_may_be_ordered_together_in_this_order) {
  task.order_reset();
  EXPECT_TRUE(task.order_run(StartKind::cold));
  EXPECT_EQ(scan(task), "AlNIFXTGO");
}

TEST_F(FaultedTaskTest, a_fault_that_is_there_stays_when_another_cycle_fails) {
  task.halt(FaultCode::other_cycle);
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_EQ(task.fault()->code, FaultCode::program_failed);
}

TEST_F(FaultedTaskTest, reset_and_run_ordered_before_another_cycle_fails_are_void) {
  task.order_reset();
  ASSERT_TRUE(task.order_run(StartKind::cold));
  task.halt(FaultCode::other_cycle);
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_TRUE(task.fault());
}

TEST_F(ScanTaskTest, orders_given_before_a_fault_are_void) {
  ScanTask task = running({.period = 10ms});
  rig.fails = true;
  in_the_middle_of(ScanAction::execute, [&] {
    task.order_reset();  // nothing to reset yet
    task.order_stop();
    EXPECT_TRUE(task.order_run(StartKind::warm));
  });
  EXPECT_EQ(scan(task), "AIFXSL");
  rig.fails = false;
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_TRUE(task.fault());
  task.order_reset();
  EXPECT_EQ(scan(task), "AlIG");
}

TEST_F(ScanTaskTest, halt_makes_outputs_safe_at_once_in_execution_in_a_wait_and_in_stop) {
  ScanTask executing = running({.period = 10ms});
  in_the_middle_of(ScanAction::execute, [&] { executing.halt(FaultCode::other_cycle); });
  EXPECT_EQ(scan(executing), "AIFXSL");
  EXPECT_EQ(executing.fault()->code, FaultCode::other_cycle);

  rig = ScanRig{};
  ScanTask waiting = running({.period = 10ms});
  waiting.halt(FaultCode::other_cycle);
  EXPECT_FALSE(waiting.order_run(StartKind::cold));
  EXPECT_TRUE(waiting.is_ready(1ms));
  rig.run_until_wait(waiting);
  EXPECT_EQ(rig.take_calls(), "SL");
  EXPECT_EQ(waiting.period().due(), 10ms);

  rig = ScanRig{};
  ScanTask stopped = make({.period = 10ms});
  scan(stopped);
  stopped.halt(FaultCode::other_cycle);
  rig.run_until_wait(stopped);
  EXPECT_EQ(rig.take_calls(), "SL");
  EXPECT_FALSE(stopped.order_run(StartKind::cold));
}

// Overrun

TEST_F(ScanTaskTest, overrun_with_skip_is_counted_and_goes_on) {
  ScanTask task = running({.period = 10ms});
  rig.duration_of(ScanAction::execute) = 25ms;
  EXPECT_EQ(scan(task), run_scan);
  EXPECT_EQ(task.period().due(), 40ms);
  EXPECT_EQ(task.period().overruns_count(), 1U);
  EXPECT_EQ(task.period().lost_starts_count(), 2U);
  EXPECT_FALSE(task.fault());
}

TEST_F(ScanTaskTest, overrun_with_catch_up_makes_up_for_every_scan) {
  ScanTask task = running({.period = 10ms, .overrun = OverrunRule::catch_up});
  rig.duration_of(ScanAction::execute) = 35ms;
  in_the_middle_of(ScanAction::execute, [&] { rig.duration_of(ScanAction::execute) = 35ms; });
  rig.now = 10ms;
  Progress last = Progress::finished;
  while (rig.now < 45ms) last = perform(task.next(rig.now, last), rig);
  rig.duration_of(ScanAction::execute) = 1ms;
  while (true) {
    const ScanStep step = task.next(rig.now, last);
    if (step.action == ScanAction::wait && step.until > rig.now) break;
    last = perform(step, rig);
  }
  EXPECT_EQ(task.scan_times().scans_count, 5U);  // due at 0, 10, 20, 30, 40
  EXPECT_EQ(rig.now, 48ms);
  EXPECT_EQ(task.period().due(), 50ms);
  EXPECT_EQ(task.period().lost_starts_count(), 0U);
}

TEST_F(ScanTaskTest, overrun_with_stop_is_a_fault_after_the_outputs) {
  ScanTask task = running({.period = 10ms, .overrun = OverrunRule::stop});
  rig.duration_of(ScanAction::execute) = 10ms;
  EXPECT_EQ(scan(task), run_scan);
  rig.duration_of(ScanAction::execute) = 10ms + 1ns;
  EXPECT_EQ(scan(task), "AIFXTGOSL");
  EXPECT_EQ(task.fault(), (Fault{FaultCode::overrun, ScanAction::write_outputs, 3, 10ms + 1ns}));
  EXPECT_EQ(task.period().due(), 40ms);
}

TEST_F(ScanTaskTest, overrun_with_stop_is_a_fault_too_when_the_host_starts_a_scan_a_period_late) {
  ScanTask task = running({.period = 10ms, .overrun = OverrunRule::stop});
  rig.now = 20ms - 1ns;
  EXPECT_EQ(scan(task), run_scan);
  rig.now = 30ms;
  EXPECT_EQ(scan(task), "SL");
  EXPECT_EQ(task.fault()->code, FaultCode::overrun);
  EXPECT_EQ(task.period().due(), 40ms);
}

TEST_F(ScanTaskTest, overrun_in_stop_is_only_counted) {
  ScanTask task = make({.period = 10ms, .overrun = OverrunRule::stop});
  rig.duration_of(ScanAction::system_analysis) = 25ms;
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_EQ(task.period().overruns_count(), 1U);
  EXPECT_FALSE(task.fault());
}

TEST_F(ScanTaskTest, watchdog_is_named_when_a_scan_breaks_both_limits) {
  ScanTask task = running({.period = 10ms, .overrun = OverrunRule::stop, .watchdog_limit = 20ms});
  rig.duration_of(ScanAction::write_outputs) = 21ms;
  scan(task);
  EXPECT_EQ(task.fault()->code, FaultCode::watchdog);
}

TEST_F(ScanTaskTest, late_start_in_stop_is_only_counted) {
  ScanTask task = make({.period = 10ms, .overrun = OverrunRule::stop});
  rig.now = 25ms;
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_EQ(task.period().lost_starts_count(), 2U);
}

TEST_F(ScanTaskTest, reset_without_a_fault_does_nothing) {
  ScanTask task = running({.period = 10ms});
  task.order_reset();
  EXPECT_EQ(scan(task), run_scan);
}

TEST_F(ScanTaskTest, a_clock_that_steps_back_stands_still) {
  ScanTask task = running({.period = 10ms});
  rig.duration_of(ScanAction::system_analysis) = 2ms;
  in_the_middle_of(ScanAction::write_outputs, [&] { rig.now = 1ms; });
  EXPECT_EQ(scan(task), run_scan);
  EXPECT_EQ(task.scan_times().now, 2ms);
}

}  // namespace
}  // namespace emulator_models::soft_plc
