#include "emulator_models/soft_plc/real_time_values.hpp"

#include <sys/mman.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <thread>
#include <utility>
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

/// Memory that a reader copies into, of two pages; whenever he comes to the other page, `overtake` is called in the
/// middle of his copying.
class TrappedMemory {
 public:
  explicit TrappedMemory(std::function<void()> overtake) : overtake_{std::move(overtake)} {
    pages_ = static_cast<std::byte*>(mmap(nullptr, 2 * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    current = this;
    struct sigaction action = {};
    action.sa_flags = SA_SIGINFO;
    action.sa_sigaction = [](int, siginfo_t* info, void*) {
      current->open(static_cast<std::byte*>(info->si_addr));
    };
    sigaction(SIGSEGV, &action, &before_);
  }
  TrappedMemory(const TrappedMemory&) = delete;
  TrappedMemory& operator=(const TrappedMemory&) = delete;
  ~TrappedMemory() {
    sigaction(SIGSEGV, &before_, nullptr);
    munmap(pages_, 2 * page);
  }
  [[nodiscard]] std::span<std::uint64_t> words() const {
    return {reinterpret_cast<std::uint64_t*>(pages_), words_count};
  }

  static constexpr std::size_t page = 4096;
  static constexpr std::size_t words_count = 2 * page / sizeof(std::uint64_t);
  int times_overtaken = 0;

 private:
  void open(const std::byte* at) {
    const bool second = at >= pages_ + page;
    if (at < pages_ || at >= pages_ + 2 * page) std::abort();  // a fault of the code, not of ours
    mprotect(pages_ + (second ? page : 0), page, PROT_READ | PROT_WRITE);
    mprotect(pages_ + (second ? 0 : page), page, PROT_NONE);
    ++times_overtaken;
    overtake_();
  }

  static inline TrappedMemory* current = nullptr;
  std::function<void()> overtake_;
  std::byte* pages_ = nullptr;
  struct sigaction before_ = {};
};

TEST(RealTimeValues, a_reader_who_is_overtaken_again_and_again_gives_up_and_says_busy) {  // I4
  RealTimeValues values{TrappedMemory::words_count};
  std::uint64_t scan = 0;
  int publishes = 2;
  const auto publish = [&] {
    for (int i = 0; i < publishes; ++i) values.publish({++scan, {}}, {});
  };
  publish();
  TrappedMemory memory{publish};
  ScanStamp stamp{77, nanoseconds{7}};
  EXPECT_EQ(values.read(memory.words(), stamp), ReadOutcome::busy);
  EXPECT_GE(memory.times_overtaken, RealTimeValues::tries_max);
  EXPECT_EQ(stamp, (ScanStamp{77, nanoseconds{7}}));
  publishes = 0;
  EXPECT_EQ(values.read(memory.words(), stamp), ReadOutcome::read);
  EXPECT_EQ(stamp.scan_number, scan);
}

TEST(RealTimeValues, one_publish_into_the_other_buffer_does_not_disturb_a_reader) {  // I4
  RealTimeValues values{TrappedMemory::words_count};
  values.publish({1, {}}, {});
  bool once = true;
  TrappedMemory memory{[&] {
    if (std::exchange(once, false)) values.publish({2, {}}, {});
  }};
  ScanStamp stamp;
  EXPECT_EQ(values.read(memory.words(), stamp), ReadOutcome::read);
  EXPECT_EQ(stamp.scan_number, 1U);
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
