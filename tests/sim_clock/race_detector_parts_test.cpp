// The race detector against an oracle that keeps every access there ever was.

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "sim_clock/check/race_detector.hpp"
#include "sim_clock/explore/random_generator.hpp"

namespace ltsim {
namespace {

/// Forgets nothing.
class Oracle {
 public:
  explicit Oracle(const HappensBefore& order) : order_(order) {}

  /// @return whether the access races with an earlier one
  bool access(const SharedAccess& access) {
    const Ticks* const known = order_.known_to(access.task);
    const bool races = std::any_of(all_.begin(), all_.end(), [&](const Entry& earlier) {
      const bool overlap = earlier.access.place < access.place + access.bytes &&
                           access.place < earlier.access.place + earlier.access.bytes;
      return overlap && earlier.ticks > known[earlier.access.task] &&
             (earlier.access.writes || access.writes) && (earlier.access.plain || access.plain);
    });
    all_.push_back({.access = access, .ticks = order_.now(access.task)});
    return races;
  }

 private:
  struct Entry {
    SharedAccess access;
    Ticks ticks;
  };
  const HappensBefore& order_;
  std::vector<Entry> all_;
};

TEST(RaceDetector, finds_the_first_race_exactly_where_nothing_forgotten_would_find_it) {
  HappensBefore order;
  RaceDetector detector{order, std::size_t{1} << 20U};
  std::size_t with_race = 0;
  for (std::uint64_t seed = 1; seed <= 2'000; ++seed) {
    order.reset();
    detector.reset();
    Oracle oracle{order};
    RandomGenerator random{seed};
    const std::uint32_t tasks = 2 + random.below(11);  // more than a step of the clocks' width
    for (TaskId task = 0; task < tasks; ++task) order.begins(task);
    const std::uint32_t careless = random.below(3);  // of fifty accesses: without a lock; 0: no race can be
    const std::uint32_t locks = random.below(4) == 0 ? 2 : 1;
    const std::uint32_t writes = 1 + random.below(5);
    bool raced = false;
    for (int step = 0; step < 200 && !raced; ++step) {
      const auto task = static_cast<TaskId>(random.below(tasks));
      const bool locked = random.below(50) >= careless;
      const SyncKey lock = SyncKey::object(random.below(locks));
      if (locked) order.acquire(task, lock);
      constexpr std::array<std::uint8_t, 5> widths{1, 2, 4, 8, 16};
      const SharedAccess access{.task = task,
                                .place = static_cast<SharedPlace>(random.below(40)),
                                .bytes = widths[random.below(widths.size())],
                                .writes = random.below(10) < writes,
                                .plain = random.below(2) == 0,
                                .site = 0};
      raced = oracle.access(access);
      static_cast<void>(detector.access(access));
      if (locked) order.release(task, lock);
      ASSERT_EQ(detector.race().has_value(), raced) << "seed " << seed << ", step " << step;
    }
    with_race += raced ? 1 : 0;
  }
  EXPECT_GT(with_race, 500U);
  EXPECT_LT(with_race, 1'800U);
}

TEST(RaceDetector, tells_who_wrote_last) {
  HappensBefore order;
  order.reset();
  RaceDetector detector{order, std::size_t{1} << 20U};
  detector.reset();
  for (TaskId task = 0; task < 2; ++task) order.begins(task);
  const auto access = [&](TaskId task, bool writes, std::uint32_t site) {
    return detector.access(
        {.task = task, .place = 16, .bytes = 4, .writes = writes, .plain = false, .site = site});
  };
  EXPECT_EQ(access(0, false, 1).task, RaceDetector::LastWrite::nobody);
  EXPECT_EQ(access(1, true, 2).task, RaceDetector::LastWrite::nobody);
  EXPECT_EQ(access(0, false, 3).task, 1);
  EXPECT_EQ(access(0, false, 3).site, 2U);
}

TEST(HappensBefore, a_dead_task_comes_before_who_knows_of_its_death) {
  HappensBefore order;
  order.reset();
  for (TaskId task = 0; task < 2; ++task) order.begins(task);
  const Ticks then = order.now(0);
  EXPECT_LT(order.known_to(1)[0], then);
  order.follows(1, 0);
  EXPECT_EQ(order.known_to(1)[0], then);
  EXPECT_GT(order.now(0), then);
}

TEST(HappensBefore, keeps_thousands_of_keys_apart) {
  HappensBefore order;
  order.reset();
  for (TaskId task = 0; task < 2; ++task) order.begins(task);
  std::vector<Ticks> released;
  for (std::uint64_t key = 0; key < 5'000; ++key) {
    released.push_back(order.now(0));
    order.release(0, SyncKey::atomic(0x7f0000000000 + 4 * key));
  }
  for (std::uint64_t key = 0; key < 5'000; ++key) {
    order.acquire(1, SyncKey::atomic(0x7f0000000000 + 4 * key));
    ASSERT_EQ(order.known_to(1)[0], released[key]);
  }
}

}  // namespace
}  // namespace ltsim
