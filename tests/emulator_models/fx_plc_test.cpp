// An FX PLC scanned step by step in simulated time: the watchdog, faults, RUN and STOP.
#include "emulator_models/fx_plc.hpp"

#include <array>
#include <cstdint>

#include <gtest/gtest.h>

#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"
#include "tests/emulator_models/soft_plc/il_rig.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using protocol::fx::Model;

struct FxPlcRig {
  explicit FxPlcRig(std::string_view variables, std::string_view body, FxPlcConfig config = {})
      : program{soft_plc::compile(soft_plc::program_of(variables, body), FxAddressMap{Model::fx3u}).value()},
        plc{emulator, program, [this](Terminals& wires, SteadyTime) { work(wires); }, &port, config, now} {}

  /// Each slice of the program takes 1 ms, everything else no time.
  void scan() {
    for (;;) {
      const auto step = plc.advance(now, wall);
      if (step.action == soft_plc::ScanAction::execute) now += 1ms;
      if (step.action != soft_plc::ScanAction::wait) continue;
      now = std::max(now, SteadyTime{step.until});
      return;
    }
  }
  void set(std::string_view device, std::uint32_t value) {
    emulator.lock()->set(protocol::fx::parse_device(device, Model::fx3u).value(), value);
  }
  std::uint32_t get(std::string_view device) {
    return emulator.lock()->get(protocol::fx::parse_device(device, Model::fx3u).value());
  }

  void work(Terminals& wires) {
    ++plant_calls;
    seen = wires;
    wires.inputs = inputs;
    wires.analog_inputs = analog_inputs;
  }

  SteadyTime now{1h};
  WallTime wall{};
  TerminalPoints inputs;
  std::array<std::uint16_t, Terminals::analogs_count> analog_inputs{};
  Terminals seen;  ///< by the plant, in the latest scan
  int plant_calls = 0;
  FxPlcEmulator emulator{Model::fx3u};
  ScanBoundaryPort port{emulator};
  soft_plc::IlProgram program;
  FxPlc plc;
};

constexpr std::string_view endless_when_x0 = "LD TRUE\nST y\nhere: LD hang\nJMPC here";
constexpr std::string_view endless_variables = "y AT Y0 : BOOL; hang AT M0 : BOOL;";

TEST(FxPlc, an_endless_loop_is_caught_by_the_watchdog_within_its_limit_and_a_slice) {
  FxPlcRig rig{endless_variables, endless_when_x0, {.watchdog_limit = 150ms, .slice_instructions = 1000}};
  rig.scan();
  EXPECT_TRUE(rig.plc.terminals().outputs[0]);
  rig.set("M0", 1);
  const SteadyTime start = rig.now;
  rig.scan();
  ASSERT_TRUE(rig.plc.fault().has_value());
  EXPECT_EQ(rig.plc.fault()->code, soft_plc::FaultCode::watchdog);
  EXPECT_LE(rig.plc.fault()->scan_time, 151ms);
  EXPECT_GE(rig.now - start, 150ms);
  EXPECT_EQ(rig.get("D8061"), 6105U);
  EXPECT_EQ(rig.get("M8061"), 1U);
  EXPECT_EQ(rig.get("M8004"), 1U);
  EXPECT_EQ(rig.get("M8000"), 0U);
  EXPECT_TRUE(rig.plc.cpu_error_lamp());
  EXPECT_FALSE(rig.plc.terminals().outputs[0]);
  rig.scan();
  EXPECT_EQ(rig.plc.mode(), soft_plc::RunMode::stop);
}

TEST(FxPlc, a_scan_that_begins_too_late_by_more_than_the_limit_is_caught_and_by_the_limit_is_normal) {
  FxPlcRig rig{"y AT Y0 : BOOL;", "LD TRUE\nST y", {.watchdog_limit = 150ms}};
  rig.scan();
  rig.now += 150ms;
  rig.scan();
  EXPECT_FALSE(rig.plc.fault().has_value());
  EXPECT_TRUE(rig.plc.terminals().outputs[0]);
  rig.now += 150ms + 1ns;
  rig.scan();
  EXPECT_EQ(rig.get("D8061"), 6105U);
  EXPECT_FALSE(rig.plc.terminals().outputs[0]);
}

TEST(FxPlc, an_order_of_run_clears_a_fault_and_starts_with_a_first_scan) {
  FxPlcRig rig{endless_variables, endless_when_x0, {.watchdog_limit = 200ms, .slice_instructions = 1000}};
  rig.scan();
  rig.set("M0", 1);
  rig.scan();
  EXPECT_TRUE(rig.plc.cpu_error_lamp());
  rig.set("M8035", 1);
  rig.set("M8036", 1);
  rig.scan();  // M0 is not latched
  EXPECT_FALSE(rig.plc.fault().has_value());
  EXPECT_FALSE(rig.plc.cpu_error_lamp());
  EXPECT_EQ(rig.get("D8061"), 0U);
  EXPECT_EQ(rig.get("M8002"), 1U);
  rig.scan();
  EXPECT_EQ(rig.get("M8002"), 0U);
  EXPECT_TRUE(rig.plc.terminals().outputs[0]);
}

TEST(FxPlc, a_run_time_fault_leaves_its_code_and_its_line) {
  FxPlcRig rig{"d AT D0 : INT; q AT D1 : INT;", "LD 1\nST q\nLD q\nDIV d\nST q"};
  rig.scan();
  EXPECT_EQ(rig.get("M8067"), 1U);
  EXPECT_EQ(rig.get("D8067"), 6706U);
  EXPECT_EQ(rig.get("D8069"), 5U);
  EXPECT_TRUE(rig.plc.program_error_lamp());
  ASSERT_TRUE(rig.plc.program_fault().has_value());
}

TEST(FxPlc, stop_keeps_latched_devices_and_clears_the_rest) {
  FxPlcRig rig{"a AT M0 : BOOL;", "LD a"};
  rig.scan();
  for (const char* const device : {"M0", "M500", "D0", "D500"}) rig.set(device, 1);
  rig.set("M8037", 1);
  rig.scan();
  EXPECT_EQ(rig.get("M8000"), 0U);
  for (const char* const device : {"M0", "D0"}) EXPECT_EQ(rig.get(device), 0U) << device;
  for (const char* const device : {"M500", "D500"}) EXPECT_EQ(rig.get(device), 1U) << device;
  rig.set("M1", 1);
  rig.plc.set_run_switch(false);
  rig.scan();
  rig.plc.set_run_switch(true);
  rig.scan();
  EXPECT_EQ(rig.get("M8000"), 1U);
  for (const char* const device : {"M1", "M500", "D500"}) EXPECT_EQ(rig.get(device), 1U) << device;
}

TEST(FxPlc, clocks_and_calendar_follow_the_times_that_the_host_brings) {
  FxPlcConfig config;
  config.watchdog_limit = 1s;  // the pauses between these scans are no fault
  FxPlcRig rig{"", "LD TRUE", config};
  rig.wall = WallTime{std::chrono::sys_days{std::chrono::year{2024} / 2 / 29}} + 23h + 59min + 58s + 900ms;
  rig.scan();
  EXPECT_EQ(rig.get("M8013"), 0U);
  EXPECT_EQ(rig.get("D8013"), 58U);
  rig.now += 500ms;
  rig.wall += 100ms;
  rig.scan();
  EXPECT_EQ(rig.get("M8013"), 1U);
  EXPECT_EQ(rig.get("D8013"), 59U);
  EXPECT_EQ(rig.get("D8016"), 29U);
  rig.wall += 1s;
  rig.now += 500ms;
  rig.scan();
  EXPECT_EQ(rig.get("M8013"), 0U);
  EXPECT_EQ(rig.get("D8013"), 0U);
  EXPECT_EQ(rig.get("D8016"), 1U);
  EXPECT_EQ(rig.get("D8017"), 3U);
}

TEST(FxPlc, d8010_to_d8012_show_the_scan_before_the_shortest_and_the_longest_in_tenths_of_a_millisecond) {
  FxPlcConfig config;
  config.slice_instructions = 1;  // each jump is a slice, which takes 1 ms
  FxPlcRig rig{"n AT D0 : INT; i AT D1 : INT;", "LD n\nST i\nagain: LD i\nSUB 1\nST i\nGT 0\nJMPC again",
               config};
  const auto scan = [&](std::uint32_t rounds) {
    rig.set("D0", rounds);
    rig.scan();
  };
  scan(3);
  scan(5);
  EXPECT_EQ(rig.get("D8010"), 30U);
  scan(2);
  scan(1);
  EXPECT_EQ(rig.get("D8010"), 20U);
  EXPECT_EQ(rig.get("D8011"), 20U);
  EXPECT_EQ(rig.get("D8012"), 50U);
}

TEST(FxPlc, m8011_to_m8014_change_in_the_scan_that_begins_at_their_half_period) {
  FxPlcConfig config;
  config.period = 1ms;
  FxPlcRig rig{"", "LD TRUE", config};
  const SteadyTime power_up = rig.now;
  DeviceMemory expected{Model::fx3u};
  for (int i = 0; i < 120; ++i) {
    const SteadyTime start = rig.now;
    rig.scan();
    set_clock_flags(expected, start - power_up);
    for (const std::uint16_t number : {std::uint16_t{8011}, std::uint16_t{8012}, std::uint16_t{8013}}) {
      const protocol::fx::Device flag{protocol::fx::DeviceKind::m, number};
      EXPECT_EQ(rig.emulator.lock()->get(flag), expected.get(flag)) << number << " in scan " << i;
    }
  }
}

TEST(Terminals, each_point_is_its_bit_of_the_image) {
  for (std::size_t i = 0; i < Terminals::points_count; ++i) {
    TerminalPoints points;
    points.set(i);
    std::array<std::byte, Terminals::points_count / 8> image{};
    copy_points(points, image);
    std::array<std::byte, Terminals::points_count / 8> expected{};
    expected[i / 8] = std::byte{1} << (i % 8);
    EXPECT_EQ(image, expected) << i;
    EXPECT_EQ(points_of(image), points) << i;
    EXPECT_EQ(points_of(std::span{image}.first(2)).any(), i < 16) << i;
  }
}

TEST(FxPlc, with_m8033_on_a_stop_clears_nothing) {
  FxPlcRig rig{"", "LD TRUE"};
  rig.scan();
  for (const char* const device : {"M8033", "M0", "D0", "Y3", "M8037"}) rig.set(device, 1);
  rig.scan();
  EXPECT_EQ(rig.plc.mode(), soft_plc::RunMode::stop);
  for (const char* const device : {"M0", "D0", "Y3"}) EXPECT_EQ(rig.get(device), 1U) << device;
  EXPECT_FALSE(rig.plc.terminals().outputs.any());
}

TEST(FxPlc, with_m8034_on_the_program_runs_and_all_terminals_are_off) {
  FxPlcRig rig{"y AT Y5 : BOOL; w AT D210 : INT;", "LD TRUE\nST y\nLD 7\nST w"};
  rig.scan();
  EXPECT_TRUE(rig.plc.terminals().outputs[5]);
  EXPECT_EQ(rig.plc.terminals().analog_outputs[0], 7U);
  rig.set("M8034", 1);
  rig.scan();
  EXPECT_FALSE(rig.plc.terminals().outputs.any());
  EXPECT_EQ(rig.plc.terminals().analog_outputs[0], 0U);
  EXPECT_EQ(rig.get("Y5"), 1U);
  rig.set("M8034", 0);
  rig.scan();
  EXPECT_TRUE(rig.plc.terminals().outputs[5]);
}

TEST(FxPlc, d8000_written_through_the_memory_counts_from_the_next_scan_on) {
  FxPlcConfig config;
  config.slice_instructions = 1000;
  FxPlcRig rig{endless_variables, endless_when_x0, config};
  rig.scan();
  rig.set("D8000", 40);
  rig.set("M0", 1);
  rig.scan();
  ASSERT_TRUE(rig.plc.fault().has_value());
  EXPECT_EQ(rig.plc.fault()->scan_time, 41ms);
}

TEST(FxPlc, d8000_written_by_the_program_counts_from_the_next_scan_on_and_0_as_1_ms) {
  FxPlcConfig config;
  config.slice_instructions = 1000;
  FxPlcRig rig{"limit AT D8000 : INT; on AT M0 : BOOL;", "LD 0\nST limit\nhere: LD on\nJMPC here", config};
  rig.scan();
  EXPECT_FALSE(rig.plc.fault().has_value());
  rig.set("M0", 1);
  rig.scan();
  ASSERT_TRUE(rig.plc.fault().has_value());
  EXPECT_EQ(rig.plc.fault()->scan_time, 2ms);
}

TEST(FxPlc, a_cold_start_clears_latched_devices_and_is_ordered_once_or_for_good) {
  for (const bool for_good : {false, true}) {
    FxPlcConfig config;
    if (for_good) config.start = soft_plc::StartKind::cold;
    FxPlcRig rig{"", "LD TRUE", config};
    const auto stop_and_run = [&] {
      rig.set("M8037", 1);
      rig.scan();
      for (const char* const device : {"M500", "D500", "D8120"}) rig.set(device, 1);
      rig.set("M8035", 1);
      rig.set("M8036", 1);
      rig.scan();
    };
    rig.scan();
    if (!for_good) rig.plc.order_cold_start();
    stop_and_run();
    EXPECT_EQ(rig.get("M500"), 0U);
    EXPECT_EQ(rig.get("D500"), 0U);
    EXPECT_EQ(rig.get("D8120"), 1U);
    stop_and_run();
    EXPECT_EQ(rig.get("M500"), for_good ? 0U : 1U);
  }
}

TEST(FxPlc, inputs_are_latched_once_and_what_the_port_has_written_to_x_does_not_last) {  // I23
  FxPlcRig rig{"x AT X17 : BOOL; y AT Y0 : BOOL;", "LD x\nST y"};
  rig.inputs.set(15);
  rig.set("X3", 1);
  rig.scan();
  EXPECT_EQ(rig.plant_calls, 1);
  EXPECT_EQ(rig.get("X17"), 1U);
  EXPECT_EQ(rig.get("X3"), 0U);
  EXPECT_TRUE(rig.plc.terminals().outputs[0]);
  EXPECT_FALSE(rig.seen.outputs[0]);
  rig.inputs.reset();
  rig.scan();
  EXPECT_EQ(rig.plant_calls, 2);
  EXPECT_TRUE(rig.seen.outputs[0]);
  EXPECT_FALSE(rig.plc.terminals().outputs[0]);
}

TEST(FxPlc, each_terminal_is_the_device_of_its_number) {
  FxPlcRig rig{"", "LD TRUE"};
  for (const std::size_t number : {0U, 7U, 8U, 63U, 64U, 200U, 255U}) {
    rig.inputs.reset();
    rig.inputs.set(number);
    for (std::uint16_t y = 0; y < 256; ++y)
      rig.emulator.lock()->set({protocol::fx::DeviceKind::y, y}, y == number);
    rig.scan();
    EXPECT_EQ(rig.plc.terminals().outputs, rig.inputs) << number;
    for (std::uint16_t x = 0; x < 256; ++x)
      EXPECT_EQ(rig.emulator.lock()->get({protocol::fx::DeviceKind::x, x}), x == number ? 1U : 0U) << x;
  }
}

TEST(FxPlc, d200_to_d207_are_read_from_the_terminals_and_d210_to_d217_written_to_them) {
  FxPlcRig rig{"a AT D200 : INT; b AT D207 : INT; p AT D210 : INT; q AT D217 : INT;",
               "LD a\nST p\nLD b\nST q"};
  rig.analog_inputs = {11, 0, 0, 0, 0, 0, 0, 77};
  rig.scan();
  EXPECT_EQ(rig.plc.terminals().analog_outputs, rig.analog_inputs);
  EXPECT_EQ(rig.get("D208"), 0U);
}

TEST(FxPlc, with_m8039_on_scans_begin_every_d8039_ms) {
  FxPlcRig rig{"", "LD TRUE"};
  rig.set("M8039", 1);
  rig.set("D8039", 25);
  rig.scan();
  rig.scan();
  const SteadyTime start = rig.now;
  rig.scan();
  EXPECT_EQ(rig.now - start, 25ms);
  rig.set("M8039", 0);
  rig.scan();
  rig.scan();
  const SteadyTime later = rig.now;
  rig.scan();
  EXPECT_EQ(rig.now - later, 10ms);
}

}  // namespace
}  // namespace emulator_models
