#include "emulator_models/soft_plc/real_time_values.hpp"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace emulator_models::soft_plc {
namespace {

using std::chrono::nanoseconds;

TEST(RealTimeValues, before_the_first_scan_there_is_nothing) {
  RealTimeValues values{4};
  std::vector<std::uint64_t> read(4);
  ScanStamp stamp;
  EXPECT_EQ(values.read(read, stamp), ReadOutcome::nothing_published);
}

TEST(RealTimeValues, the_latest_scan_is_read_with_its_number_and_time) {
  RealTimeValues values{3};
  std::vector<std::uint64_t> read(3);
  ScanStamp stamp;
  for (std::uint64_t scan = 1; scan < 10; ++scan) {
    const std::vector<std::uint64_t> published{scan, scan + 1, scan + 2};
    const ScanStamp published_stamp{scan, nanoseconds{static_cast<std::int64_t>(scan) * 1000}};
    values.publish(published_stamp, published);
    ASSERT_EQ(values.read(read, stamp), ReadOutcome::read);
    EXPECT_EQ(read, published);
    EXPECT_EQ(stamp, published_stamp);
  }
}

TEST(RealTimeValues, missing_words_are_zero_and_further_ones_ignored) {
  RealTimeValues values{2};
  std::vector<std::uint64_t> read(2);
  ScanStamp stamp;
  for (int i = 0; i < 2; ++i) values.publish({}, std::vector<std::uint64_t>{7, 8, 9});
  ASSERT_EQ(values.read(read, stamp), ReadOutcome::read);
  EXPECT_EQ(read, (std::vector<std::uint64_t>{7, 8}));
  for (int i = 0; i < 2; ++i) values.publish({}, std::vector<std::uint64_t>{1});
  ASSERT_EQ(values.read(read, stamp), ReadOutcome::read);
  EXPECT_EQ(read, (std::vector<std::uint64_t>{1, 0}));
}

TEST(RealTimeValues, a_snapshot_is_of_one_scan_and_never_older_than_the_one_before) {  // I2, I3
  constexpr std::size_t words = 300;
  constexpr std::uint64_t scans = 50'000;
  RealTimeValues values{words};
  std::thread cycle{[&] {
    std::vector<std::uint64_t> images(words);
    for (std::uint64_t scan = 1; scan <= scans; ++scan) {
      images.assign(words, scan);
      values.publish({scan, nanoseconds{static_cast<std::int64_t>(scan)}}, images);
    }
  }};
  std::vector<std::uint64_t> read(words);
  std::uint64_t before = 0;
  bool torn = false;
  while (before < scans && !torn) {
    ScanStamp stamp;
    if (values.read(read, stamp) != ReadOutcome::read) continue;
    torn = stamp.scan_number < before || read != std::vector<std::uint64_t>(words, stamp.scan_number);
    before = stamp.scan_number;
  }
  cycle.join();
  EXPECT_FALSE(torn) << "around scan " << before;
}

}  // namespace
}  // namespace emulator_models::soft_plc
