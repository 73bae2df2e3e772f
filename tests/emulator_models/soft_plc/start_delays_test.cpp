// The histogram of scan starts against what it was given.
#include "emulator_models/soft_plc/start_delays.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/emulator_models/soft_plc/plc_rig.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

TEST(StartDelays, a_delay_is_counted_in_the_range_that_begins_with_it) {
  StartDelays delays;
  for (const nanoseconds delay : {0ns, 9'999ns, 10'000ns, 19'999ns, 20'000ns}) delays.add(delay);
  EXPECT_EQ(delays.count_in(0), 2U);
  EXPECT_EQ(delays.count_in(1), 2U);
  EXPECT_EQ(delays.count_in(2), 1U);
  EXPECT_EQ(delays.count(), 5U);
}

TEST(StartDelays, what_is_later_than_the_last_range_is_counted_too) {
  StartDelays delays;
  delays.add(1s - 1ns);
  delays.add(1s);
  delays.add(1h);
  EXPECT_EQ(delays.count_in(StartDelays::range_ends.size() - 1), 1U);
  EXPECT_EQ(delays.beyond(), 2U);
  EXPECT_EQ(delays.longest(), 1h);
  EXPECT_EQ(delays.percentile(1000), 1h);
}

TEST(StartDelays, nothing_counted_is_all_zero) {
  EXPECT_EQ(StartDelays{}.percentile(500), 0ns);
  EXPECT_EQ(StartDelays{}.longest(), 0ns);
}

TEST(StartDelays, percentiles_are_right_to_a_step_and_never_too_low) {
  std::mt19937 draws{7};
  std::lognormal_distribution<double> delay_ns{11.0, 1.5};
  StartDelays delays;
  std::vector<nanoseconds> all;
  for (int i = 0; i < 10'000; ++i) {
    all.emplace_back(static_cast<std::int64_t>(delay_ns(draws)));
    delays.add(all.back());
  }
  std::ranges::sort(all);
  for (const std::uint64_t permille : {1U, 500U, 990U, 999U, 1000U}) {
    const nanoseconds exact = all[permille * all.size() / 1000 - 1];
    EXPECT_GE(delays.percentile(permille), exact) << permille;
    EXPECT_LE(delays.percentile(permille), exact + exact / 6 + 1us) << permille;
  }
}

PlcCycleSetup idle_cycle(nanoseconds period) {
  return cycle("a", period, {}, 0, [](const CycleImage&, const ScanStep&) { return Progress::finished; });
}

TEST(StartDelays, of_a_cycle_are_those_of_its_scans_in_RUN_the_first_and_lost_starts_included) {
  std::vector<PlcCycleSetup> cycles;
  cycles.push_back(idle_cycle(10ms));
  const auto plc = SoftPlc::make(setup_of(std::move(cycles)), 0ns).value();
  nanoseconds now{3ms};
  run_until(*plc, now, 5ms);  // in STOP
  EXPECT_EQ(plc->start_delays(0).count(), 0U);
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  for (const nanoseconds start : {10ms, 20ms, 47ms, 50ms}) {
    now = start;
    run_until(*plc, now, start + 1ns);
  }
  EXPECT_EQ(plc->start_delays(0).count(), 4U);
  EXPECT_EQ(plc->start_delays(0).count_in(0), 3U);
  EXPECT_EQ(plc->start_delays(0).longest(), 17ms) << "due at 30 ms";
  EXPECT_EQ(plc->status(0).lost_starts_count, 1U);

  plc->order_stop();
  ASSERT_TRUE(plc->order_run(StartKind::warm));
  now = 60ms;
  run_until(*plc, now, 61ms);
  EXPECT_EQ(plc->start_delays(0).count(), 1U) << "a start of RUN begins anew";
}

}  // namespace
}  // namespace emulator_models::soft_plc
