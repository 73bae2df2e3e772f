// An FX PLC scanned step by step in simulated time: the watchdog, faults, RUN and STOP.
#include "emulator_models/fx_plc.hpp"

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
        plc{emulator, program, {}, nullptr, config, now} {}

  /// Each slice of the program takes 1 ms, everything else no time.
  void scan() {
    for (;;) {
      const auto step = plc.advance(now, {});
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

  SteadyTime now{1h};
  FxPlcEmulator emulator{Model::fx3u};
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

}  // namespace
}  // namespace emulator_models
