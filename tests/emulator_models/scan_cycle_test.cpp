// The phases of a scan, RUN and STOP, and the loop that scans.
#include "emulator_models/scan_cycle.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "tests/emulator_models/machine_rig.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;

constexpr std::byte run_state_of_first_scan{0x05};
constexpr std::byte run_state_in_run{0x09};
constexpr std::byte run_state_in_stop{0x0A};

struct ScanCycleTest : ::testing::Test, MachineRig {
  std::byte run_state() {
    return plc.with_memory([](const DeviceMemory& memory) {
      return memory.read_byte(0x01E0, protocol::fx::AddressSpace::legacy).value();
    });
  }
  void order_stop() { set("M8037", 1); }
  void order_run() {
    set("M8035", 1);
    set("M8036", 1);
  }
};

TEST_F(ScanCycleTest, the_first_scan_of_run_is_marked_as_such_and_no_other) {
  EXPECT_EQ(run_state(), run_state_in_stop);
  scan_once();
  EXPECT_EQ(run_state(), run_state_of_first_scan);
  scan_once();
  EXPECT_EQ(run_state(), run_state_in_run);
  run_for(1s);
  EXPECT_EQ(run_state(), run_state_in_run);
}

TEST_F(ScanCycleTest, phase_2_latches_the_inputs_over_what_the_port_has_written) {
  scan_once();
  set("X0", 1);  // at speed: the wire says no
  set("X5", 0);  // door closed: the wire says yes
  scan_once();
  EXPECT_EQ(get("X0"), 0U);
  EXPECT_EQ(get("X5"), 1U);
}

TEST_F(ScanCycleTest, phase_3_runs_the_program_on_the_latched_image) {
  scan_once();
  EXPECT_EQ(get("M124"), 1U);
  plant.set_door_closed(false);
  EXPECT_EQ(get("M124"), 1U);
  scan_once();
  EXPECT_EQ(get("X5"), 0U);
  EXPECT_EQ(get("M124"), 0U);
}

TEST_F(ScanCycleTest, phase_4_brings_the_outputs_to_the_terminals) {
  scan_once();
  set("Y17", 1);
  set("Y377", 1);
  EXPECT_FALSE(output("Y17"));
  scan_once();
  EXPECT_TRUE(output("Y17"));
  EXPECT_TRUE(output("Y377"));
}

TEST_F(ScanCycleTest, m8034_keeps_all_outputs_off_and_the_image_as_it_is) {
  scan_once();
  set("Y17", 1);
  set("M8034", 1);
  scan_once();
  EXPECT_FALSE(output("Y17"));
  EXPECT_EQ(get("Y17"), 1U);
  set("M8034", 0);
  scan_once();
  EXPECT_TRUE(output("Y17"));
}

TEST_F(ScanCycleTest, stop_switches_the_outputs_off_and_the_program_rests) {
  scan_once();
  set("Y17", 1);
  scan_once();
  order_stop();
  scan_once();
  EXPECT_EQ(run_state(), run_state_in_stop);
  EXPECT_FALSE(output("Y17"));
  set("D100", 99);
  set("M100", 1);
  run_for(1s);
  EXPECT_EQ(get("M120"), 0U);
  EXPECT_TRUE(take_events().empty());
}

TEST_F(ScanCycleTest, inputs_are_read_in_stop_too) {
  scan_once();
  order_stop();
  scan_once();
  plant.set_door_closed(false);
  scan_once();
  EXPECT_EQ(get("X5"), 0U);
}

TEST_F(ScanCycleTest, run_after_stop_begins_with_a_first_scan_and_a_cleared_memory) {
  scan_once();
  set("M50", 1);
  set("D50", 7);
  order_stop();
  run_for(50ms);
  EXPECT_EQ(get("M50"), 1U);
  order_run();
  scan_once();
  EXPECT_EQ(run_state(), run_state_of_first_scan);
  EXPECT_EQ(get("M50"), 0U);
  EXPECT_EQ(get("D50"), 7U);
  scan_once();
  EXPECT_EQ(run_state(), run_state_in_run);
}

TEST_F(ScanCycleTest, m8033_keeps_the_memory) {
  scan_once();
  set("M50", 1);
  set("M8033", 1);
  order_stop();
  scan_once();
  order_run();
  scan_once();
  EXPECT_EQ(get("M50"), 1U);
}

TEST_F(ScanCycleTest, what_was_written_before_the_first_scan_is_not_cleared) {
  set("M50", 1);
  scan_once();
  EXPECT_EQ(get("M50"), 1U);
}

TEST_F(ScanCycleTest, a_stop_ordered_before_the_first_scan_is_obeyed) {
  order_stop();
  scan_once();
  EXPECT_EQ(run_state(), run_state_in_stop);
}

TEST_F(ScanCycleTest, clocks_and_calendar_go_on_in_stop) {
  wall = WallTime{std::chrono::sys_days{std::chrono::year{2026} / 2 / 28}} + 23h + 59min + 59s;
  order_stop();
  scan_once();
  EXPECT_EQ(get("D8013"), 59U);
  EXPECT_EQ(get("M8013"), 0U);
  run_for(1s);
  EXPECT_EQ(get("D8017"), 3U);
  EXPECT_EQ(get("D8016"), 1U);
  EXPECT_EQ(get("M8013"), 0U);
  run_for(510ms);
  EXPECT_EQ(get("M8013"), 1U);
}

TEST_F(ScanCycleTest, every_model_has_the_terminals_that_the_machine_needs) {
  for (const auto model : {protocol::fx::Model::fx1s, protocol::fx::Model::fx1n, protocol::fx::Model::fx2n}) {
    FxPlcEmulator other_plc{model};
    MachineProgram other_program;
    MachinePlant other_plant;
    ScanCycle other_scan{other_plc, other_program, other_plant};
    other_scan.scan_once(now, wall);
    EXPECT_TRUE(other_plc.read_bit({protocol::fx::DeviceKind::m, 126}));
  }
}

TEST(ScanCycleLoop, scans_until_it_is_asked_to_stop) {
  FxPlcEmulator plc{protocol::fx::Model::fx3u};
  MachineProgram program;
  MachinePlant plant;
  ScanCycle scan{plc, program, plant, 1ms};
  std::thread thread{[&] { scan.run(); }};
  const protocol::fx::Device run_flag{protocol::fx::DeviceKind::m, 8000};
  const protocol::fx::Device first_scan_flag{protocol::fx::DeviceKind::m, 8002};
  while (!plc.read_bit(run_flag) || plc.read_bit(first_scan_flag)) std::this_thread::yield();
  scan.request_stop();
  thread.join();
}

TEST(ScanCycleLoop, a_stop_ends_the_wait_for_the_next_scan) {
  FxPlcEmulator plc{protocol::fx::Model::fx3u};
  MachineProgram program;
  MachinePlant plant;
  ScanCycle scan{plc, program, plant, 24h};
  std::thread thread{[&] { scan.run(); }};
  while (!plc.read_bit({protocol::fx::DeviceKind::m, 8000})) std::this_thread::yield();
  scan.request_stop();
  thread.join();  // or the test hangs
}

}  // namespace
}  // namespace emulator_models
