// What a cycle does, as the records that it leaves.
#include "emulator_models/soft_plc/cycle_recorder.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/emulator_models/soft_plc/scan_rig.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr nanoseconds power_up = 5h;

class CycleRecorderTest : public testing::Test {
 protected:
  void make(const ScanConfig& config = {.period = 10ms}) {
    rig.now = power_up;
    task.emplace(ScanTask::make(config, power_up).value());
  }
  /// One scan at the moment at which it is due, the recorder told of each step.
  void scan() {
    rig.now = std::max(rig.now, task->period().due());
    for (Progress last = Progress::finished;;) {
      const ScanStep step = task->next(rig.now, last);
      recorder.observe(*task, task->scan_number(), rig.now);
      if (step.action == ScanAction::wait) return;
      last = perform(step, rig);
    }
  }
  void scan_until(nanoseconds since_power_up) {
    while (task->period().due() - power_up < since_power_up) scan();
  }
  void run() { ASSERT_TRUE(task->order_run(StartKind::cold)); }
  std::vector<EventRecord> taken(std::optional<EventKind> kind = {}) {
    std::vector<EventRecord> records(ring.capacity());
    records.resize(ring.take(records));
    if (kind) std::erase_if(records, [&](const EventRecord& record) { return record.kind != *kind; });
    return records;
  }

  EventRing ring{1024};
  CycleRecorder recorder{ring, 7, power_up};
  ScanRig rig;
  std::optional<ScanTask> task;
};

TEST_F(CycleRecorderTest, a_span_sums_up_its_scans_with_shortest_longest_and_sum) {
  make();
  run();
  for (int i = 0; i < 5; ++i) {
    rig.duration_of(ScanAction::execute) = (i + 1) * 1ms;
    scan();
  }
  recorder.finish(rig.now);
  const auto records = taken(EventKind::scans);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].cycle, 7);
  EXPECT_EQ(records[0].scan_number, 5U);
  EXPECT_EQ(records[0].time_ns, (rig.now - power_up).count());
  EXPECT_EQ(records[0].values, (std::array<std::int64_t, 5>{5, 1'000'000, 5'000'000, 15'000'000, 0}));
}

TEST_F(CycleRecorderTest, a_span_lasts_a_second) {
  make();
  run();
  scan_until(3500ms);
  const auto records = taken(EventKind::scans);
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(records[0].time_ns, nanoseconds{1s}.count());
  EXPECT_EQ(records[2].time_ns, nanoseconds{3s}.count());
}

TEST_F(CycleRecorderTest, counts_of_all_spans_add_up_to_the_scans_of_RUN_over_stops_and_faults) {  // I2
  make();
  std::uint64_t scans = 0;
  for (int round = 0; round < 3; ++round) {
    run();
    for (int i = 0; i < 150; ++i) scan();
    scans += task->scan_times().scans_count;
    if (round == 1) {
      rig.duration_of(ScanAction::execute) = 1s;
      scan();
      rig.duration_of(ScanAction::execute) = 0ms;
      task->order_reset();
    }
    task->order_stop();
    for (int i = 0; i < 20; ++i) scan();
  }
  recorder.finish(rig.now);
  std::int64_t sum = 0;
  for (const EventRecord& record : taken(EventKind::scans)) sum += record.values[0];
  EXPECT_EQ(static_cast<std::uint64_t>(sum), scans);
  EXPECT_EQ(scans, 450U);
}

TEST_F(CycleRecorderTest, each_overrun_has_a_record_up_to_a_bound_and_the_sum_counts_all) {
  make();
  run();
  rig.duration_of(ScanAction::execute) = 15ms;
  for (std::uint64_t i = 0; i < CycleRecorder::overruns_per_span + 5; ++i) scan();
  recorder.finish(rig.now);
  const auto records = taken();
  std::uint64_t overruns = 0;
  for (const EventRecord& record : records) {
    if (record.kind != EventKind::overrun) continue;
    EXPECT_EQ(record.values[0], nanoseconds{15ms}.count());
    EXPECT_EQ(record.scan_number, ++overruns);
  }
  EXPECT_EQ(overruns, CycleRecorder::overruns_per_span);
  EXPECT_EQ(records.back().kind, EventKind::scans);
  EXPECT_EQ(records.back().values[4], static_cast<std::int64_t>(CycleRecorder::overruns_per_span) + 5);
}

TEST_F(CycleRecorderTest, an_overrun_in_STOP_has_no_scan_time) {
  make();
  rig.duration_of(ScanAction::read_inputs) = 15ms;
  scan();
  const auto records = taken(EventKind::overrun);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].values[0], -1);
}

TEST_F(CycleRecorderTest, what_led_to_a_fault_stands_before_it_and_the_change_to_STOP_behind) {
  make({.period = 10ms, .watchdog_limit = 100ms});
  run();
  for (int i = 0; i < 3; ++i) scan();
  rig.duration_of(ScanAction::execute) = 150ms;
  scan();
  const auto records = taken();
  ASSERT_EQ(records.size(), 5U);
  EXPECT_EQ(records[0].kind, EventKind::mode_change);
  EXPECT_EQ(records[0].code, static_cast<std::uint16_t>(RunMode::run));
  EXPECT_EQ(records[0].scan_number, 1U);
  EXPECT_EQ(records[1].kind, EventKind::scans);
  EXPECT_EQ(records[1].values[0], 3);
  EXPECT_EQ(records[2].kind, EventKind::fault);
  EXPECT_EQ(records[2].code, static_cast<std::uint16_t>(FaultCode::watchdog));
  EXPECT_EQ(records[2].scan_number, 4U);
  EXPECT_EQ(records[2].values[0], static_cast<std::int64_t>(ScanAction::execute));
  EXPECT_EQ(records[2].values[1], nanoseconds{150ms}.count());
  EXPECT_EQ(records[3].kind, EventKind::mode_change);
  EXPECT_EQ(records[3].code, static_cast<std::uint16_t>(RunMode::stop));
  EXPECT_EQ(records[4].kind, EventKind::overrun);
}

TEST_F(CycleRecorderTest, a_fault_in_STOP_ends_the_span_too) {
  make();
  rig.duration_of(ScanAction::read_inputs) = 15ms;
  scan();
  task->halt(FaultCode::other_cycle);
  scan();
  const auto records = taken();
  ASSERT_GE(records.size(), 3U);
  EXPECT_EQ(records[0].kind, EventKind::overrun);
  EXPECT_EQ(records[1].kind, EventKind::scans);
  EXPECT_EQ(records[2].kind, EventKind::fault);
}

TEST_F(CycleRecorderTest, the_place_in_the_program_belongs_to_the_fault_of_the_program_only) {
  make({.period = 10ms, .watchdog_limit = 100ms});
  run();
  scan();
  recorder.program_failed_at({12, 3});
  rig.fails = true;
  scan();
  rig.fails = false;
  task->order_reset();
  run();
  scan();
  recorder.program_failed_at({12, 3});
  rig.duration_of(ScanAction::execute) = 150ms;
  scan();
  const auto faults = taken(EventKind::fault);
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].code, static_cast<std::uint16_t>(FaultCode::program_failed));
  EXPECT_EQ(faults[0].values[2], 12);
  EXPECT_EQ(faults[0].values[3], 3);
  EXPECT_EQ(faults[1].code, static_cast<std::uint16_t>(FaultCode::watchdog));
  EXPECT_EQ(faults[1].values[2], 0);
}

TEST_F(CycleRecorderTest, a_reset_is_recorded_with_the_code_of_the_fault_that_it_ends) {
  make();
  run();
  scan();
  rig.fails = true;
  scan();
  (void)taken();
  task->order_reset();
  scan();
  const auto records = taken(EventKind::fault_cleared);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].code, static_cast<std::uint16_t>(FaultCode::program_failed));
}

TEST_F(CycleRecorderTest, a_step_pushes_no_more_records_than_it_says) {  // I1
  make({.period = 10ms, .overrun = OverrunRule::stop, .watchdog_limit = 1s});
  run();
  scan();
  rig.duration_of(ScanAction::execute) = 15ms;
  (void)taken();
  rig.now = task->period().due();
  std::size_t most = 0;
  for (Progress last = Progress::finished;;) {
    const ScanStep step = task->next(rig.now, last);
    recorder.observe(*task, task->scan_number(), rig.now);
    most = std::max(most, taken().size());
    if (step.action == ScanAction::wait) break;
    last = perform(step, rig);
  }
  EXPECT_EQ(most, 4U) << "overrun, scans, fault, mode";
  EXPECT_LE(most, static_cast<std::size_t>(CycleRecorder::records_per_step_max));
}

}  // namespace
}  // namespace emulator_models::soft_plc
