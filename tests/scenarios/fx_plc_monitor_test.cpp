// The monitor of an FX PLC names what is broken. The PLC is sound, so the monitor is told something else: another
// limit or period than the PLC has, not every step, or it is shown a memory that somebody has changed.
#include "tests/scenarios/fx_plc_monitor.hpp"

#include <string>

#include <gtest/gtest.h>

#include "sim_clock/explore/swarm_strategy.hpp"
#include "tests/scenarios/compiled_program.hpp"
#include "tests/scenarios/search.hpp"

namespace {

using namespace std::chrono_literals;
using namespace emulator_models;
using protocol::fx::Device;
using protocol::fx::DeviceKind;
using soft_plc::ScanAction;

constexpr auto period = 10ms;
constexpr auto limit = 200ms;

struct FxPlcMonitorTest : ::testing::Test {
  FxPlcMonitorTest() { world.reset(strategy, nullptr); }
  ~FxPlcMonitorTest() override { world.end_execution(); }

  /// @param untold  a step that the monitor does not hear of
  void scan_at(scenarios::FxPlcMonitor& monitor, std::chrono::nanoseconds time,
               ScanAction untold = ScanAction::clear_fault) {
    const SteadyTime now{time};
    for (soft_plc::ScanStep step{ScanAction::system_analysis}; step.action != ScanAction::wait;) {
      step = plc.advance(now, WallTime{});
      if (step.action != untold) monitor.advanced(plc, step, now);
    }
  }
  void change(scenarios::FxPlcMonitor& monitor, Device device) {
    emulator.with_memory([&](DeviceMemory& memory) {
      memory.set(device, memory.get(device) == 0);
      monitor.look(plc, memory);
    });
  }
  [[nodiscard]] std::string broken() { return world.scheduler().outcome().message.substr(0, 3); }

  ltsim::World& world = scenarios::world();
  ltsim::SwarmStrategy strategy;
  soft_plc::IlProgram program =
      scenarios::compiled_for_fx3u("PROGRAM p\nVAR y AT Y0 : BOOL; END_VAR\nLD TRUE\nST y\nEND_PROGRAM\n");
  FxPlcEmulator emulator{protocol::fx::Model::fx3u};
  FxPlc plc{emulator, program, {}, nullptr, {.period = period, .watchdog_limit = limit}, SteadyTime{}};
};

TEST_F(FxPlcMonitorTest, is_silent_about_a_sound_plc_even_when_the_watchdog_bites) {
  scenarios::FxPlcMonitor monitor{world, period, limit, SteadyTime{}};
  for (const auto time : {0ms, 10ms, 209ms, 420ms, 430ms}) scan_at(monitor, time);
  EXPECT_EQ(broken(), "");
  EXPECT_TRUE(plc.fault().has_value());
}

TEST_F(FxPlcMonitorTest, names_a_scan_that_begins_later_than_the_watchdog_allows) {
  scenarios::FxPlcMonitor monitor{world, period, limit / 2, SteadyTime{}};
  for (const auto time : {0ms, 150ms}) scan_at(monitor, time);
  EXPECT_EQ(broken(), "I20");
}

TEST_F(FxPlcMonitorTest, names_a_bite_before_the_limit) {
  scenarios::FxPlcMonitor monitor{world, period, 2 * limit, SteadyTime{}};
  for (const auto time : {0ms, 300ms}) scan_at(monitor, time);
  EXPECT_EQ(broken(), "I21");
}

TEST_F(FxPlcMonitorTest, names_an_input_that_changes_after_it_was_latched) {
  scenarios::FxPlcMonitor monitor{world, period, limit, SteadyTime{}};
  scan_at(monitor, 0ms);
  change(monitor, {DeviceKind::x, 3});
  EXPECT_EQ(broken(), "I23");
}

TEST_F(FxPlcMonitorTest, names_an_output_that_is_not_what_the_program_left) {
  scenarios::FxPlcMonitor monitor{world, period, limit, SteadyTime{}};
  scan_at(monitor, 0ms);
  change(monitor, {DeviceKind::y, 0});
  EXPECT_EQ(broken(), "I24");
}

TEST_F(FxPlcMonitorTest, names_an_output_that_changes_although_no_scan_writes) {
  scenarios::FxPlcMonitor monitor{world, period, limit, SteadyTime{}};
  scan_at(monitor, 0ms, ScanAction::write_outputs);
  EXPECT_EQ(broken(), "I24");
}

TEST_F(FxPlcMonitorTest, names_a_run_that_begins_without_an_initialisation) {
  scenarios::FxPlcMonitor monitor{world, period, limit, SteadyTime{}};
  scan_at(monitor, 0ms, ScanAction::initialise);
  EXPECT_EQ(broken(), "I25");
}

TEST_F(FxPlcMonitorTest, names_a_scan_before_its_point_of_the_grid) {
  scenarios::FxPlcMonitor monitor{world, 2 * period, limit, SteadyTime{}};
  for (const auto time : {0ms, 10ms}) scan_at(monitor, time);
  EXPECT_EQ(broken(), "I26");
}

}  // namespace
