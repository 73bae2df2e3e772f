// The grid of starts, and the three rules for scans that overrun it.
#include "emulator_models/soft_plc/scan_period.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr OverrunRule all_rules[] = {OverrunRule::stop, OverrunRule::skip, OverrunRule::catch_up};

/// One scan, started when it is due.
bool overruns(ScanPeriod& period, nanoseconds scan_time) {
  const nanoseconds start = period.due();
  EXPECT_FALSE(period.begin_scan(start));
  return period.end_scan(start + scan_time);
}

TEST(ScanPeriod, a_scan_that_ends_before_or_on_the_next_start_is_in_time) {
  for (const OverrunRule rule : all_rules) {
    ScanPeriod period{10ms, rule, 100ms};
    EXPECT_EQ(period.due(), 100ms);
    EXPECT_FALSE(overruns(period, 3ms));
    EXPECT_EQ(period.due(), 110ms);
    EXPECT_FALSE(overruns(period, 10ms));
    EXPECT_EQ(period.due(), 120ms);
    EXPECT_EQ(period.overruns_count(), 0U);
    EXPECT_EQ(period.lost_starts_count(), 0U);
  }
}

TEST(ScanPeriod, overrun_begins_one_nanosecond_after_the_next_start) {
  for (const OverrunRule rule : all_rules) {
    ScanPeriod period{10ms, rule, 0ms};
    EXPECT_TRUE(overruns(period, 10ms + 1ns));
    EXPECT_EQ(period.overruns_count(), 1U);
  }
}

TEST(ScanPeriod, overrun_with_skip_goes_to_the_next_point_of_the_grid_and_counts_the_lost_ones) {
  ScanPeriod period{10ms, OverrunRule::skip, 0ms};
  EXPECT_TRUE(overruns(period, 25ms));
  EXPECT_EQ(period.due(), 30ms);
  EXPECT_EQ(period.lost_starts_count(), 2U);
  EXPECT_TRUE(overruns(period, 20ms));
  EXPECT_EQ(period.due(), 50ms);  // ended on a point of the grid, which is kept
  EXPECT_EQ(period.lost_starts_count(), 3U);
}

TEST(ScanPeriod, overrun_with_catch_up_starts_at_once_until_the_grid_is_reached) {
  ScanPeriod period{10ms, OverrunRule::catch_up, 0ms};
  EXPECT_TRUE(overruns(period, 25ms));
  nanoseconds now = 25ms;
  std::vector<nanoseconds> starts;
  while (period.due() <= 40ms) {
    now = std::max(now, period.due());
    starts.push_back(now);
    EXPECT_FALSE(period.begin_scan(now));
    now += 1ms;
    (void)period.end_scan(now);
  }
  EXPECT_EQ(starts, (std::vector<nanoseconds>{25ms, 26ms, 30ms, 40ms}));
  EXPECT_EQ(period.lost_starts_count(), 0U);
}

TEST(ScanPeriod, overrun_with_catch_up_gives_up_what_is_beyond_its_bound) {
  for (const int behind : {100, 101, 1000}) {
    ScanPeriod period{10ms, OverrunRule::catch_up, 0ms};
    EXPECT_EQ(period.begin_scan(behind * 10ms), behind > ScanPeriod::catch_up_max);
    EXPECT_EQ(period.lost_starts_count(), static_cast<unsigned>(behind - 100));
    EXPECT_EQ(period.start_delay(), behind * 10ms);
  }
}

TEST(ScanPeriod, late_start_by_less_than_a_period_keeps_the_grid) {
  for (const OverrunRule rule : all_rules) {
    ScanPeriod period{10ms, rule, 0ms};
    EXPECT_FALSE(period.begin_scan(10ms - 1ns));
    EXPECT_EQ(period.start_delay(), 10ms - 1ns);
    EXPECT_FALSE(period.end_scan(10ms));
    EXPECT_EQ(period.due(), 10ms);
  }
}

TEST(ScanPeriod, late_start_by_a_period_or_more_loses_starts) {
  for (const OverrunRule rule : {OverrunRule::stop, OverrunRule::skip}) {
    ScanPeriod period{10ms, rule, 0ms};
    EXPECT_TRUE(period.begin_scan(25ms));
    EXPECT_EQ(period.lost_starts_count(), 2U);
    EXPECT_EQ(period.start_delay(), 25ms) << "the lost ones included";
    EXPECT_FALSE(period.end_scan(30ms));
    EXPECT_EQ(period.due(), 30ms);
  }
}

TEST(ScanPeriod, zero_is_due_at_the_end_of_the_scan_before_and_never_overruns) {
  for (const OverrunRule rule : all_rules) {
    ScanPeriod period{0ms, rule, 5ms};
    EXPECT_FALSE(period.begin_scan(7ms));
    EXPECT_FALSE(period.end_scan(1h));
    EXPECT_EQ(period.due(), 1h);
    EXPECT_EQ(period.overruns_count() + period.lost_starts_count(), 0U);
  }
}

// I1 to I3
TEST(ScanPeriod, random_scans_and_delays_keep_the_invariants) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    std::mt19937_64 random{seed};
    const auto up_to = [&](std::uint64_t us) { return std::chrono::microseconds{random() % us}; };
    for (const OverrunRule rule : all_rules) {
      ScanPeriod period{10ms, rule, 0ms};
      nanoseconds end{0};
      nanoseconds point_before{-10ms};
      std::uint64_t starts = 0;
      for (int scan = 0; scan < 200; ++scan) {
        if (rule != OverrunRule::catch_up) {
          ASSERT_GE(period.due(), end);  // I2
        }
        const nanoseconds start = std::max(end, period.due()) + (random() % 4 == 0 ? up_to(40'000) : 0us);
        (void)period.begin_scan(start);
        ++starts;
        ASSERT_EQ(period.due() % 10ms, 0ns);
        ASSERT_GT(period.due(), point_before);                                    // I1
        ASSERT_EQ(period.due() / 10ms + 1, starts + period.lost_starts_count());  // I3
        point_before = period.due();
        end = start + up_to(random() % 8 == 0 ? 60'000 : 9'000);
        (void)period.end_scan(end);
      }
    }
  }
}

}  // namespace
}  // namespace emulator_models::soft_plc
