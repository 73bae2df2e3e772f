// What an FxPlc leaves with its recorder: scans, faults, writes of the port, signals, current values.
#include "emulator_models/fx_recorder.hpp"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/fx_plc.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"
#include "tests/emulator_models/soft_plc/il_rig.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using protocol::fx::Command;
using protocol::fx::Model;
using soft_plc::EventKind;
using soft_plc::EventRecord;

protocol::fx::Device device(std::string_view name) {
  return protocol::fx::parse_device(name, Model::fx3u).value();
}

class FxRecorderTest : public testing::Test {
 protected:
  FxRecorderTest() { plc.observe_with(&recorder); }
  void scan() {
    for (;;) {
      const auto step = plc.advance(now, {});
      if (step.action != soft_plc::ScanAction::wait) continue;
      now = std::max(now, SteadyTime{step.until});
      return;
    }
  }
  /// One request, served by the next scan.
  protocol::fx::FrameBytes request(const protocol::fx::Request& asked) {
    protocol::fx::FrameBytes answer;
    const auto frame = protocol::fx::encode(asked);
    std::atomic<bool> done{false};
    std::thread field_device{[&] {
      answer = port.process(protocol::fx::as_span(frame));
      done = true;
    }};
    while (!done) scan();
    field_device.join();
    return answer;
  }
  std::vector<EventRecord> taken(EventKind kind) {
    std::vector<EventRecord> records(recorder.ring().capacity());
    records.resize(recorder.ring().take(records));
    std::erase_if(records, [&](const EventRecord& record) { return record.kind != kind; });
    return records;
  }

  SteadyTime now{1h};
  FxPlcEmulator emulator{Model::fx3u};
  soft_plc::IlProgram program =
      soft_plc::compile(
          soft_plc::program_of("n AT D0 : INT; d AT D1 : INT; go AT M0 : BOOL; y AT Y17 : BOOL;",
                               "LD n\nADD 1\nST n\nLD go\nST y\nLD 1\nDIV d\nST d"),
          FxAddressMap{Model::fx3u})
          .value();
  ScanBoundaryPort port{emulator, 10s};
  /// In the middle of a scan.
  soft_plc::ScanStamp seen_by_plant;
  FxPlc plc{
      emulator, program, [this](Terminals&, SteadyTime) { (void)recorder.values().read({}, seen_by_plant); },
      &port,    {},      now};
  FxRecorder recorder{
      {.signals = {device("M0"), device("Y17")}, .values = {device("D0"), device("Y17")}}, Model::fx3u, now};
};

TEST_F(FxRecorderTest, a_fault_of_the_program_has_its_line) {
  scan();
  const auto faults = taken(EventKind::fault);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].code, static_cast<std::uint16_t>(soft_plc::FaultCode::program_failed));
  EXPECT_EQ(faults[0].values[2], plc.program_fault()->place.line);
  EXPECT_GT(faults[0].values[2], 0);
}

TEST_F(FxRecorderTest, scans_and_the_start_of_RUN_are_recorded_with_times_since_power_up) {
  emulator.lock()->set(device("D1"), 1);
  for (int i = 0; i < 250; ++i) scan();
  recorder.finish(now);
  std::vector<EventRecord> records(recorder.ring().capacity());
  records.resize(recorder.ring().take(records));
  ASSERT_EQ(records.size(), 4U);
  EXPECT_EQ(records[0].kind, EventKind::mode_change);
  EXPECT_EQ(records[0].time_ns, 0);
  EXPECT_EQ(records[1].values[0] + records[2].values[0] + records[3].values[0], 250);
  EXPECT_EQ(records[1].time_ns, std::chrono::nanoseconds{1s}.count());
}

TEST_F(FxRecorderTest, chosen_bits_are_recorded_with_the_scan_in_which_they_change) {
  emulator.lock()->set(device("D1"), 1);
  for (int i = 0; i < 3; ++i) scan();
  emulator.lock()->set(device("M0"), 1);
  scan();
  const auto changes = taken(EventKind::signal_change);
  ASSERT_EQ(changes.size(), 2U);
  for (std::uint16_t i = 0; i < 2; ++i) {
    EXPECT_EQ(changes[i].code, i);
    EXPECT_EQ(changes[i].scan_number, 4U);
    EXPECT_EQ(changes[i].values[1], 1);
  }
}

TEST_F(FxRecorderTest, the_values_of_the_latest_scan_can_be_read) {
  emulator.lock()->set(device("D1"), 1);
  emulator.lock()->set(device("M0"), 1);
  std::array<std::uint64_t, 2> read{};
  soft_plc::ScanStamp stamp;
  EXPECT_EQ(recorder.values().read(read, stamp), soft_plc::ReadOutcome::nothing_published);
  for (std::uint64_t i = 1; i <= 5; ++i) {
    scan();
    ASSERT_EQ(recorder.values().read(read, stamp), soft_plc::ReadOutcome::read);
    EXPECT_EQ(read, (std::array<std::uint64_t, 2>{i, 1}));
    EXPECT_EQ(stamp.scan_number, i);
    EXPECT_EQ(seen_by_plant.scan_number, i - 1);
  }
}

TEST_F(FxRecorderTest, acknowledged_writes_of_the_port_are_recorded_and_nothing_else) {
  emulator.lock()->set(device("D1"), 1);
  const auto address =
      protocol::fx::byte_address(device("D100"), Model::fx3u, protocol::fx::AddressSpace::legacy);
  const auto bit = protocol::fx::bit_number(device("M8"), Model::fx3u, protocol::fx::AddressSpace::wide);
  (void)request({.command = Command::read, .address = *address, .count_bytes = 2, .data = {}});
  (void)request({.command = Command::write,
                 .address = *address,
                 .count_bytes = 4,
                 .data = {std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}}});
  (void)request({.command = Command::force_on_wide, .address = *bit, .data = {}});
  (void)request({.command = Command::write, .address = 0xFFFE, .count_bytes = 1, .data = {std::byte{1}}});
  const auto writes = taken(EventKind::port_write);
  ASSERT_EQ(writes.size(), 2U);
  EXPECT_EQ(writes[0].code, static_cast<std::uint16_t>(PortArea::bytes));
  EXPECT_EQ(writes[0].values, (std::array<std::int64_t, 5>{*address, 4, 0x04030201}));
  EXPECT_GT(writes[0].scan_number, 0U);
  EXPECT_EQ(writes[1].code, static_cast<std::uint16_t>(PortArea::bits_wide));
  EXPECT_EQ(writes[1].values, (std::array<std::int64_t, 5>{*bit, 1, 1}));
}

}  // namespace
}  // namespace emulator_models
