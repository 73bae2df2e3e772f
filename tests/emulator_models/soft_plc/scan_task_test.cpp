// One cycle: its phases, RUN and STOP, its scan times.
#include "emulator_models/soft_plc/scan_task.hpp"

#include <gtest/gtest.h>

#include "tests/emulator_models/soft_plc/scan_task_fixture.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

TEST_F(ScanTaskTest, the_seven_phases_come_in_their_order) {
  ScanTask task = running({.period = 10ms});
  EXPECT_EQ(scan(task), run_scan);
  EXPECT_EQ(scan(task), run_scan);
  const ScanStep step = task.next(rig.now);
  EXPECT_EQ(step.action, ScanAction::wait);
  EXPECT_EQ(step.until, 30ms);
}

TEST_F(ScanTaskTest, the_classic_cycle_has_no_exchanges) {
  ScanTask task = running({.period = 10ms, .exchanges_with_cycles = false});
  EXPECT_EQ(scan(task), "AIXGO");
}

TEST_F(ScanTaskTest, a_cycle_begins_in_stop_and_writes_no_outputs_before_the_first_run) {
  ScanTask task = make({.period = 10ms});
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_EQ(task.mode(), RunMode::stop);
}

TEST_F(ScanTaskTest, execute_is_ordered_again_until_it_has_finished) {
  ScanTask task = running({.period = 10ms});
  rig.slices_per_scan = 4;
  EXPECT_EQ(scan(task), "AIFXXXXTGO");
}

TEST_F(ScanTaskTest, all_of_a_scan_see_the_time_at_which_it_began) {
  rig.duration_of(ScanAction::system_analysis) = 1ms;
  rig.duration_of(ScanAction::execute) = 2ms;
  ScanTask task = running({.period = 10ms});
  EXPECT_EQ(rig.last_execute.scan_start, 0ms);
  rig.slices_per_scan = 2;
  scan(task);
  EXPECT_EQ(rig.last_execute.scan_start, 10ms);
  EXPECT_EQ(rig.last_execute.until, 160ms);
}

TEST_F(ScanTaskTest, with_period_0_a_scan_follows_the_other_without_waiting) {
  ScanTask task = make({});
  ASSERT_TRUE(task.order_run(StartKind::cold));
  rig.duration_of(ScanAction::execute) = 3ms;
  Progress last = Progress::finished;
  while (rig.now < 9ms) last = perform(task.next(rig.now, last), rig);
  EXPECT_EQ(rig.calls,
            "ANIFX"
            "TGOAIFX"
            "TGOAIFX");
}

// RUN and STOP

TEST_F(ScanTaskTest, the_first_scan_of_run_is_marked_as_such_and_no_other) {
  ScanTask task = running({.period = 10ms});
  EXPECT_TRUE(rig.last_execute.first_scan);
  scan(task);
  EXPECT_FALSE(rig.last_execute.first_scan);
}

TEST_F(ScanTaskTest, start_of_run_is_cold_or_warm_as_ordered) {
  for (const StartKind kind : {StartKind::cold, StartKind::warm}) {
    ScanTask task = make({.period = 10ms});
    ASSERT_TRUE(task.order_run(kind));
    Progress last = Progress::finished;
    ScanStep step;
    while (step.action != ScanAction::initialise) {
      step = task.next(rig.now, last);
      last = perform(step, rig);
    }
    EXPECT_EQ(step.start, kind);
    EXPECT_TRUE(step.first_scan);
  }
}

TEST_F(ScanTaskTest, stop_makes_outputs_safe_once_and_then_reads_inputs_and_refreshes_the_image) {
  ScanTask task = running({.period = 10ms});
  task.order_stop();
  EXPECT_EQ(scan(task), "ASIG");
  EXPECT_EQ(scan(task), stop_scan);
  EXPECT_EQ(task.mode(), RunMode::stop);
}

TEST_F(ScanTaskTest, outputs_in_stop_stay_as_they_are_with_hold) {
  ScanTask task = running({.period = 10ms, .outputs_in_stop = OutputsInStop::hold});
  task.order_stop();
  EXPECT_EQ(scan(task), stop_scan);
}

TEST_F(ScanTaskTest, run_after_stop_begins_with_an_initialisation_and_a_first_scan) {
  ScanTask task = running({.period = 10ms});
  task.order_stop();
  scan(task);
  ASSERT_TRUE(task.order_run(StartKind::warm));
  EXPECT_EQ(scan(task), first_run_scan);
  EXPECT_TRUE(rig.last_execute.first_scan);
  EXPECT_EQ(rig.last_execute.start, StartKind::warm);
}

TEST_F(ScanTaskTest, an_order_in_system_analysis_counts_in_that_scan) {
  ScanTask task = running({.period = 10ms});
  in_the_middle_of(ScanAction::system_analysis, [&] { task.order_stop(); });
  EXPECT_EQ(scan(task), "ASIG");
  in_the_middle_of(ScanAction::system_analysis, [&] { EXPECT_TRUE(task.order_run(StartKind::warm)); });
  EXPECT_EQ(scan(task), first_run_scan);
}

// I1
TEST_F(ScanTaskTest, stop_in_mid_scan_lets_the_scan_finish_with_its_outputs) {
  for (const ScanAction action :
       {ScanAction::read_inputs, ScanAction::read_from_cycles, ScanAction::execute,
        ScanAction::write_to_cycles, ScanAction::refresh_output_image, ScanAction::write_outputs}) {
    ScanTask task = running({.period = 10ms});
    in_the_middle_of(action, [&] { task.order_stop(); });
    EXPECT_EQ(scan(task), run_scan);
    EXPECT_EQ(scan(task), "ASIG");
  }
}

// I1
TEST_F(ScanTaskTest, run_in_mid_scan_counts_from_the_next_scan_on) {
  for (const ScanAction action : {ScanAction::read_inputs, ScanAction::refresh_output_image}) {
    ScanTask task = make({.period = 10ms});
    in_the_middle_of(action, [&] { EXPECT_TRUE(task.order_run(StartKind::cold)); });
    EXPECT_EQ(scan(task), stop_scan);
    EXPECT_EQ(scan(task), first_run_scan);
  }
}

// I2
TEST_F(ScanTaskTest, stop_and_run_between_two_scans_are_a_restart) {
  ScanTask task = running({.period = 10ms});
  task.order_stop();
  ASSERT_TRUE(task.order_run(StartKind::warm));
  EXPECT_EQ(scan(task), first_run_scan);
  EXPECT_EQ(scan(task), run_scan);
}

TEST_F(ScanTaskTest, a_restart_ordered_in_mid_scan_does_not_change_the_start_of_that_scan) {
  ScanTask task = running({.period = 10ms});
  in_the_middle_of(ScanAction::read_inputs, [&] {
    task.order_stop();
    EXPECT_TRUE(task.order_run(StartKind::warm));
  });
  EXPECT_EQ(scan(task), run_scan);
  EXPECT_EQ(rig.last_execute.start, StartKind::cold);
}

TEST_F(ScanTaskTest, run_and_then_stop_between_two_scans_are_a_stop) {
  ScanTask task = make({.period = 10ms});
  ASSERT_TRUE(task.order_run(StartKind::cold));
  task.order_stop();
  EXPECT_EQ(scan(task), stop_scan);
}

TEST_F(ScanTaskTest, run_ordered_in_run_changes_nothing) {
  ScanTask task = running({.period = 10ms});
  EXPECT_TRUE(task.order_run(StartKind::cold));
  EXPECT_EQ(scan(task), run_scan);
}

// Scan time

TEST_F(ScanTaskTest, scan_time_is_measured_with_communication_service_and_without_waiting) {
  rig.duration_of(ScanAction::system_analysis) = 1ms;
  rig.duration_of(ScanAction::read_inputs) = 2ms;
  rig.duration_of(ScanAction::execute) = 3ms;
  rig.duration_of(ScanAction::write_outputs) = 4ms;
  ScanTask task = running({.period = 100ms});
  EXPECT_EQ(task.scan_times().now, 10ms);
  rig.duration_of(ScanAction::execute) = 1ms;
  scan(task);
  rig.duration_of(ScanAction::execute) = 2ms;
  scan(task);
  EXPECT_EQ(task.scan_times().now, 9ms);
  EXPECT_EQ(task.scan_times().shortest, 8ms);
  EXPECT_EQ(task.scan_times().longest, 10ms);
  EXPECT_EQ(task.scan_times().scans_count, 3U);
}

TEST_F(ScanTaskTest, scan_times_begin_anew_with_run_and_rest_in_stop) {
  rig.duration_of(ScanAction::execute) = 5ms;
  ScanTask task = running({.period = 10ms});
  task.order_stop();
  scan(task);
  EXPECT_EQ(task.scan_times().scans_count, 1U);
  rig.duration_of(ScanAction::execute) = 1ms;
  ASSERT_TRUE(task.order_run(StartKind::warm));
  scan(task);
  EXPECT_EQ(task.scan_times().longest, 1ms);
}

TEST_F(ScanTaskTest, start_of_run_is_that_of_the_latest_order) {
  for (const StartKind latest : {StartKind::cold, StartKind::warm}) {
    ScanTask task = make({.period = 10ms});
    EXPECT_TRUE(task.order_run(latest == StartKind::cold ? StartKind::warm : StartKind::cold));
    EXPECT_TRUE(task.order_run(latest));
    EXPECT_EQ(scan(task), first_run_scan);
    EXPECT_EQ(rig.last_execute.start, latest);
  }
}

TEST_F(ScanTaskTest, late_start_counts_from_the_moment_at_which_it_begins) {
  ScanTask task = running({.period = 10ms});
  rig.now = 15ms;
  rig.duration_of(ScanAction::execute) = 2ms;
  scan(task);
  EXPECT_EQ(rig.last_execute.scan_start, 15ms);
  EXPECT_EQ(task.scan_times().now, 2ms);
  EXPECT_EQ(task.period().due(), 20ms);
}

TEST_F(ScanTaskTest, a_long_wait_is_no_matter_for_the_watchdog) {
  ScanTask task = running({.period = 1s});
  EXPECT_EQ(scan(task), run_scan);
  EXPECT_FALSE(task.fault());
}

TEST(ScanConfig, values_at_their_bounds_are_taken_and_others_refused_with_the_way_out) {
  const auto error = [](const ScanConfig& config) {
    const auto task = ScanTask::make(config, 0ns);
    return task ? std::string_view{} : to_string(task.error());
  };
  EXPECT_EQ(error({.period = 0ns}), "");
  EXPECT_EQ(error({.period = 1h}), "");
  EXPECT_EQ(error({.period = -1ns}), "the period must be 0 (no waiting) or a time of up to 1 h");
  EXPECT_EQ(error({.period = nanoseconds{1h} + 1ns}),
            "the period must be 0 (no waiting) or a time of up to 1 h");
  EXPECT_EQ(error({.watchdog_limit = 1ns}), "");
  EXPECT_EQ(error({.watchdog_limit = 1h}), "");
  EXPECT_EQ(error({.watchdog_limit = 0ns}),
            "the watchdog's limit must be above 0 and up to 1 h; usual is 150 ms");
  EXPECT_EQ(error({.watchdog_limit = nanoseconds{1h} + 1ns}),
            "the watchdog's limit must be above 0 and up to 1 h; usual is 150 ms");
}

}  // namespace
}  // namespace emulator_models::soft_plc
