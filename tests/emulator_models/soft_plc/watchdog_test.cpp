// The limit of one scan, and the scan times.
#include "emulator_models/soft_plc/watchdog.hpp"

#include <gtest/gtest.h>

#include "emulator_models/soft_plc/scan_times.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;

TEST(ScanWatchdog, bites_after_150_ms_by_default_and_equality_is_still_normal) {
  Watchdog dog;
  dog.begin_scan(1s);
  EXPECT_FALSE(dog.bites(1s + 150ms));
  EXPECT_TRUE(dog.bites(1s + 150ms + 1ns));
  EXPECT_EQ(dog.deadline(), 1s + 150ms);
}

TEST(ScanWatchdog, each_scan_is_measured_from_its_own_start) {
  Watchdog dog{10ms};
  dog.begin_scan(0s);
  dog.begin_scan(8ms);
  EXPECT_FALSE(dog.bites(18ms));
  EXPECT_TRUE(dog.bites(19ms));
}

TEST(ScanTimes, show_the_latest_the_shortest_and_the_longest_scan) {
  ScanTimes times;
  EXPECT_EQ(times.shortest, 0ms);
  for (const auto scan_time : {5ms, 2ms, 9ms, 4ms}) times.add(scan_time);
  EXPECT_EQ(times.now, 4ms);
  EXPECT_EQ(times.shortest, 2ms);
  EXPECT_EQ(times.longest, 9ms);
  EXPECT_EQ(times.mean(), 5ms);
  EXPECT_EQ(times.scans_count, 4U);
}

}  // namespace
}  // namespace emulator_models::soft_plc
