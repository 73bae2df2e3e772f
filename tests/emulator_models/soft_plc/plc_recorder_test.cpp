// What a SoftPlc leaves with its recorder, each cycle in its own ring.
#include "emulator_models/soft_plc/plc_recorder.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "emulator_models/soft_plc/il_compiler.hpp"
#include "emulator_models/soft_plc/il_cycle.hpp"
#include "tests/emulator_models/soft_plc/plc_rig.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

class PlcRecorderTest : public testing::Test {
 protected:
  PlcRecorderTest() {
    std::vector<PlcCycleSetup> cycles;
    cycles.push_back(cycle("fast", 1ms, {}, 0, [this](const CycleImage& image, const ScanStep&) {
      set_word(image.outputs, word(image.outputs) + 1);
      return fails ? Progress::failed : Progress::finished;
    }));
    cycles.push_back(cycle("slow", 10ms, {}, 8, [](const CycleImage& image, const ScanStep&) {
      set_word(image.outputs, word(image.memory), 8);
      return Progress::finished;
    }));
    SoftPlcSetup setup = setup_of(std::move(cycles));
    setup.observer = &recorder;
    plc = SoftPlc::make(std::move(setup), 0ns).value();
    EXPECT_TRUE(plc->order_run(StartKind::cold));
  }
  /// All cycles, each as if on a thread of its own.
  void run_cycles_until(nanoseconds end) {
    for (; now < end; now += 1ms) {
      for (std::size_t i = 0; i < plc->cycles_count(); ++i) {
        while (plc->advance_cycle(i, now) <= now) {
        }
      }
    }
  }
  std::vector<EventRecord> taken(std::size_t cycle_number, EventKind kind) {
    EventRing& ring = *recorder.rings()[cycle_number];
    std::vector<EventRecord> records(ring.capacity());
    records.resize(ring.take(records));
    for (const EventRecord& record : records) EXPECT_EQ(record.cycle, cycle_number);
    std::erase_if(records, [&](const EventRecord& record) { return record.kind != kind; });
    return records;
  }
  std::int64_t scans_of(std::size_t cycle_number) {
    std::int64_t scans = 0;
    for (const EventRecord& record : taken(cycle_number, EventKind::scans)) scans += record.values[0];
    return scans;
  }

  bool fails = false;
  nanoseconds now{0};
  PlcRecorder recorder{{.signals = {parse_address("%QX0.0").value(), parse_address("%QX8.1").value()},
                        .values = {parse_address("%QD0").value(), parse_address("%QX8.1").value()}},
                       2,
                       0ns};
  std::unique_ptr<SoftPlc> plc;
};

TEST_F(PlcRecorderTest, each_cycle_records_its_own_scans_also_when_all_share_a_thread) {
  run_until(*plc, now, 2500ms);
  recorder.finish(now);
  EXPECT_EQ(scans_of(0), 2500);
  EXPECT_EQ(scans_of(1), 250);
}

TEST_F(PlcRecorderTest, and_when_each_has_a_thread) {
  run_cycles_until(2500ms);
  recorder.finish(now);
  EXPECT_EQ(scans_of(0), 2500);
  EXPECT_EQ(scans_of(1), 250);
}

TEST_F(PlcRecorderTest, values_and_signals_are_those_of_whole_scans) {
  for (const bool one_thread : {true, false}) {
    one_thread ? run_until(*plc, now, now + 20ms) : run_cycles_until(now + 20ms);
    std::array<std::uint64_t, 2> values{};
    ScanStamp stamp;
    ASSERT_EQ(recorder.values(0).read(values, stamp), ReadOutcome::read);
    EXPECT_EQ(values[0], stamp.scan_number);
    EXPECT_EQ(values[0], plc->status(0).scan_times.scans_count);
  }
  std::uint64_t scan = 1;  // has no before
  for (const EventRecord& change : taken(0, EventKind::signal_change)) {
    EXPECT_EQ(change.scan_number, ++scan);
    EXPECT_EQ(change.values[1], static_cast<std::int64_t>(scan % 2));
  }
  EXPECT_EQ(scan, plc->status(0).scan_times.scans_count);
}

TEST_F(PlcRecorderTest, a_cycle_without_pauses_has_its_whole_scans_recorded) {
  SoftPlcSetup setup;
  setup.slice_intervals = {0ns};
  setup.cycles.push_back(cycle("restless", 0ns, {}, 0, [](const CycleImage& image, const ScanStep&) {
    set_word(image.outputs, word(image.outputs) + 1);
    return Progress::finished;
  }));
  setup.observer = &recorder;
  plc = SoftPlc::make(std::move(setup), 0ns).value();
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  for (int i = 0; i < 1000; ++i) (void)plc->advance(now += 1us);
  std::array<std::uint64_t, 2> values{};
  ScanStamp stamp;
  ASSERT_EQ(recorder.values(0).read(values, stamp), ReadOutcome::read);
  EXPECT_EQ(values[0], stamp.scan_number);
  EXPECT_GT(stamp.scan_number, 100U);
}

TEST_F(PlcRecorderTest, writes_of_the_gateway_are_recorded_with_their_cycle_address_and_bytes) {
  run_until(*plc, now, 5ms);
  const auto ticket = plc->gateway().submit(
      {.cycle = 1,
       .items = {{.area = Area::memory, .section = {0, 4}, .written = {}},
                 {.area = Area::memory, .section = {0, 0}, .written = {std::byte{2}, std::byte{1}}},
                 {.area = Area::memory, .section = {9, 0}, .written = {std::byte{1}}, .bit = 5}}});
  ASSERT_TRUE(ticket);
  run_until(*plc, now, 30ms);
  const auto writes = taken(1, EventKind::port_write);
  ASSERT_EQ(writes.size(), 2U);
  EXPECT_EQ(writes[0].code, static_cast<std::uint16_t>(Area::memory));
  EXPECT_EQ(writes[0].values, (std::array<std::int64_t, 5>{0, 2, 0x0102}));
  EXPECT_EQ(writes[0].scan_number, 2U);
  EXPECT_EQ(writes[1].values, (std::array<std::int64_t, 5>{9, 1, 1, 6}));
  EXPECT_EQ(taken(1, EventKind::port_write).size() + taken(0, EventKind::port_write).size(), 0U);
}

TEST_F(PlcRecorderTest, a_fault_is_recorded_by_the_cycle_that_has_it_and_by_those_that_it_stops) {
  run_until(*plc, now, 5ms);
  fails = true;
  run_until(*plc, now, 20ms);
  const auto own = taken(0, EventKind::fault);
  const auto other = taken(1, EventKind::fault);
  ASSERT_EQ(own.size(), 1U);
  ASSERT_EQ(other.size(), 1U);
  EXPECT_EQ(own[0].code, static_cast<std::uint16_t>(FaultCode::program_failed));
  EXPECT_EQ(other[0].code, static_cast<std::uint16_t>(FaultCode::other_cycle));
}

TEST_F(PlcRecorderTest, the_fault_of_a_program_is_recorded_with_its_line_and_column_in_each_threading) {
  for (const bool one_thread : {true, false}) {
    auto program = compile("PROGRAM p\nVAR n : INT; END_VAR\n  LD 1\n  DIV n\nEND_PROGRAM\n");
    ASSERT_TRUE(program);
    SoftPlcSetup setup;
    setup.slice_intervals = {0ns};
    setup.cycles.push_back(
        {"divides", cycle("", 1ms, {}, 0, {}).config, {}, std::make_unique<IlCycle>(*program)});
    setup.observer = &recorder;
    plc = SoftPlc::make(std::move(setup), now).value();
    ASSERT_TRUE(plc->order_run(StartKind::cold));
    one_thread ? run_until(*plc, now, now + 5ms) : run_cycles_until(now + 5ms);
    const auto faults = taken(0, EventKind::fault);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].code, static_cast<std::uint16_t>(FaultCode::program_failed));
    EXPECT_EQ(faults[0].values[2], 4) << "line";
    EXPECT_EQ(faults[0].values[3], 3) << "column";
  }
}

}  // namespace
}  // namespace emulator_models::soft_plc
