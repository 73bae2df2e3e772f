// Several cycles on one processor: who goes on, and what a fault of one means for the others.
#include "emulator_models/soft_plc/scan_scheduler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "tests/emulator_models/soft_plc/scan_rig.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr std::size_t letter_a = 'a';

/// All cycles run; a slice of a program takes 1 ms, all other steps no time.
struct Plc {
  explicit Plc(const SchedulerConfig& config) : scheduler{ScanScheduler::make(config, 0ns).value()} {
    for (std::size_t i = 0; i < config.cycles.size(); ++i) {
      EXPECT_TRUE(scheduler.cycle(i).order_run(StartKind::cold));
      rigs[i].duration_of(ScanAction::execute) = 1ms;
    }
  }

  /// @return the cycles in the order of their slices of the program, a letter each; S: safe outputs were written
  std::string run_until(nanoseconds end) {
    std::string order;
    while (now < end) {
      const ScanScheduler::Slice slice = scheduler.next(now, last);
      if (!slice.cycle) {
        EXPECT_GT(slice.step.until, now);
        now = std::min(slice.step.until, end);
        continue;
      }
      ScanRig& rig = rigs[*slice.cycle];
      rig.now = now;
      last = perform(slice.step, rig);
      now = rig.now;
      const char letter = static_cast<char>(letter_a + *slice.cycle);
      if (slice.step.action == ScanAction::execute) order += letter;
      if (slice.step.action == ScanAction::enter_fault) order += {'S', letter};
    }
    return order;
  }

  ScanScheduler scheduler;
  std::array<ScanRig, 3> rigs;
  nanoseconds now{0};
  Progress last = Progress::finished;
};

TEST(ScanScheduler, cycles_run_with_their_own_periods) {
  Plc plc({.cycles = {{.scan = {.period = 5ms}}, {.scan = {.period = 20ms}}}, .slice_intervals = {0ns}});
  EXPECT_EQ(plc.run_until(40ms), "abaaabaaaa");
}

TEST(ScanScheduler, a_higher_priority_goes_on_between_the_slices_of_a_lower_one) {
  Plc plc({.cycles = {{.scan = {.period = 5ms}, .priority = 0}, {.scan = {.period = 40ms}, .priority = 1}},
           .slice_intervals = {0ns, 0ns}});
  plc.rigs[1].slices_per_scan = 10;
  EXPECT_EQ(plc.run_until(40ms), "abbbbabbbbabbaaaaa");
}

// I2
TEST(ScanScheduler, equal_priorities_get_their_steps_in_turn_longest_waiting_first) {
  Plc plc({.cycles = {{.scan = {.period = 100ms}}, {.scan = {.period = 100ms}}, {.scan = {.period = 100ms}}},
           .slice_intervals = {0ns}});
  for (ScanRig& rig : plc.rigs) rig.slices_per_scan = 3;
  EXPECT_EQ(plc.run_until(50ms), "abcabcabc");
}

/// Notes when the rig does steps of this kind, which take no time.
void watch(ScanRig& rig, ScanAction action, std::vector<nanoseconds>& times) {
  rig.during = [&rig, action, &times](ScanAction done) {
    if (done == action) times.push_back(rig.now);
  };
}

TEST(ScanScheduler, a_cycle_whose_scan_is_due_waits_behind_those_that_wait_longer) {
  const ScanConfig endless{.watchdog_limit = 1h};
  Plc plc({.cycles = {{.scan = endless}, {.scan = endless}, {.scan = {.period = 9ms}}},
           .slice_intervals = {0ns}});
  for (const std::size_t i : {0, 1}) {
    plc.rigs[i].slices_per_scan = 1'000'000;
    plc.rigs[i].duration_of(ScanAction::execute) = 4ms;
  }
  plc.scheduler.cycle(2).order_stop();
  std::vector<nanoseconds> times;
  watch(plc.rigs[2], ScanAction::system_analysis, times);
  plc.run_until(17ms);
  // a 0-4, b 4-8, a 8-12; then b has waited since 8 and c since 9.
  EXPECT_EQ(times, (std::vector<nanoseconds>{0ms, 16ms}));
}

TEST(ScanScheduler, of_two_timers_that_have_ticked_the_higher_priority_goes_first) {
  const ScanConfig endless{.watchdog_limit = 1h};
  Plc plc({.cycles = {{.scan = endless, .priority = 0}, {.scan = endless, .priority = 1}},
           .slice_intervals = {2ms, 1ms}});
  plc.rigs[1].slices_per_scan = 1'000'000;
  plc.rigs[1].duration_of(ScanAction::execute) = 4ms;
  std::vector<nanoseconds> times;
  watch(plc.rigs[0], ScanAction::initialise, times);
  plc.run_until(8ms);
  // At 0 each has its tick, then the lower one is the next to tick; at 4 both have ticked, the lower one first.
  EXPECT_EQ(times, (std::vector<nanoseconds>{4ms}));
}

TEST(ScanScheduler, priorities_without_interval_let_nothing_below_them_pass) {
  Plc plc({.cycles = {{.priority = 1}, {.priority = 0}}, .slice_intervals = {0ns, 0ns}});
  EXPECT_EQ(plc.run_until(5ms), "bbbbb");
}

TEST(ScanScheduler, a_timer_of_higher_frequency_gets_slices_more_often) {
  Plc plc({.cycles = {{.scan = {.watchdog_limit = 1h}, .priority = 0},
                      {.scan = {.watchdog_limit = 1h}, .priority = 1}},
           .slice_intervals = {3ms, 9ms}});
  for (ScanRig& rig : plc.rigs) rig.slices_per_scan = 1'000'000;
  const std::string order = plc.run_until(900ms);
  const auto of_low = std::count(order.begin(), order.end(), 'b');
  EXPECT_EQ(order.size(), 900U);  // never idle
  EXPECT_EQ(of_low, 96);          // 100 ticks; four went to the steps before its first slice of the program
}

// I3
TEST(ScanScheduler, a_fault_in_one_cycle_stops_all_before_any_does_another_step) {
  Plc plc({.cycles = {{.scan = {.period = 5ms}}, {.scan = {.period = 5ms}}, {.scan = {.period = 5ms}}},
           .slice_intervals = {0ns}});
  plc.rigs[1].fails = true;
  EXPECT_EQ(plc.run_until(30ms), "abSbScSa");
  EXPECT_EQ(plc.scheduler.cycle(0).fault()->code, FaultCode::other_cycle);
  EXPECT_EQ(plc.scheduler.cycle(1).fault()->code, FaultCode::program_failed);
  EXPECT_EQ(plc.scheduler.cycle(2).fault()->code, FaultCode::other_cycle);
}

// I4
TEST(ScanScheduler, time_of_other_cycles_counts_and_the_starved_cycle_is_told_at_once) {
  Plc plc({.cycles = {{.scan = {.period = 1s, .watchdog_limit = 20ms}, .priority = 1},
                      {.scan = {.period = 5ms, .watchdog_limit = 1h}, .priority = 0}},
           .slice_intervals = {0ns, 0ns}});
  plc.rigs[0].slices_per_scan = 10;
  EXPECT_EQ(plc.run_until(2ms), "ba");
  plc.rigs[1].slices_per_scan = 1'000'000;  // from its next scan on, at 5 ms, the higher one never ends
  const std::string order = plc.run_until(60ms);
  EXPECT_EQ(plc.scheduler.cycle(0).fault()->code, FaultCode::watchdog);
  EXPECT_LE(plc.scheduler.cycle(0).fault()->scan_time, 21ms);
  EXPECT_EQ(order.substr(order.find('S')), "SaSb");
}

TEST(ScanScheduler, all_waiting_means_wait_until_the_first_is_due) {
  Plc plc({.cycles = {{.scan = {.period = 50ms}}, {.scan = {.period = 20ms}}}, .slice_intervals = {0ns}});
  plc.run_until(3ms);
  const ScanScheduler::Slice slice = plc.scheduler.next(3ms);
  EXPECT_FALSE(slice.cycle);
  EXPECT_EQ(slice.step.action, ScanAction::wait);
  EXPECT_EQ(slice.step.until, 20ms);
}

TEST(ScanScheduler, bad_configurations_are_refused_with_the_way_out) {
  const auto error = [](const SchedulerConfig& config) {
    return std::string{to_string(ScanScheduler::make(config, 0ns).error())};
  };
  EXPECT_EQ(error({.cycles = {{.priority = 1}}, .slice_intervals = {0ns}}),
            "a cycle has a priority for which there is no slice interval; give one interval for each "
            "priority from 0 on");
  EXPECT_EQ(error({.cycles = {}, .slice_intervals = {-1ns}}),
            "a slice interval must be 0 (always) or a time of up to 1 h");
  EXPECT_EQ(error({.cycles = {}, .slice_intervals = {nanoseconds{1h} + 1ns}}),
            "a slice interval must be 0 (always) or a time of up to 1 h");
  EXPECT_TRUE(ScanScheduler::make({.cycles = {}, .slice_intervals = {1h}}, 0ns));
  EXPECT_EQ(error({.cycles = {{.scan = {.period = -1ns}}}, .slice_intervals = {0ns}}),
            "the period or the watchdog's limit of a cycle is out of range");
}

}  // namespace
}  // namespace emulator_models::soft_plc
