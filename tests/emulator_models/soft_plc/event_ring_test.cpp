#include "emulator_models/soft_plc/event_ring.hpp"

#include <array>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace emulator_models::soft_plc {
namespace {

EventRecord numbered(std::uint64_t number) { return {.kind = EventKind::overrun, .scan_number = number}; }

std::vector<EventRecord> all_of(EventRing& ring) {
  std::vector<EventRecord> taken(ring.capacity());
  taken.resize(ring.take(taken));
  return taken;
}

TEST(EventRing, gives_back_in_order_each_record_once) {  // I1
  EventRing ring{8};
  for (std::uint64_t i = 0; i < 100; ++i) {
    ASSERT_TRUE(ring.push(numbered(2 * i)));
    ASSERT_TRUE(ring.push(numbered(2 * i + 1)));
    EXPECT_EQ(all_of(ring), (std::vector{numbered(2 * i), numbered(2 * i + 1)}));
  }
  EXPECT_TRUE(all_of(ring).empty());
}

TEST(EventRing, holds_its_capacity_and_not_one_more) {
  EventRing ring{4};
  for (std::uint64_t i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(numbered(i)));
  EXPECT_FALSE(ring.push(numbered(4)));
  EXPECT_EQ(ring.lost_count(), 1u);
  EXPECT_EQ(all_of(ring).size(), 4u);
}

TEST(EventRing, capacity_is_a_power_of_two_within_its_limits) {
  EXPECT_EQ(EventRing{0}.capacity(), EventRing::capacity_min);
  EXPECT_EQ(EventRing{5}.capacity(), 8u);
  EXPECT_EQ(EventRing{EventRing::capacity_max + 1}.capacity(), EventRing::capacity_max);
}

TEST(EventRing, a_gap_is_told_once_in_the_place_where_it_is) {  // I3
  EventRing ring{2};
  for (std::uint64_t i = 0; i < 5; ++i) (void)ring.push(numbered(i));
  EXPECT_EQ(all_of(ring), (std::vector{numbered(0), numbered(1)}));
  EXPECT_EQ(ring.gap(), (EventRecord{.kind = EventKind::records_lost, .scan_number = 4, .values = {3}}));
  EXPECT_TRUE(ring.push(numbered(5)));
  const EventRecord gap{.kind = EventKind::records_lost, .scan_number = 5, .values = {3}};
  EXPECT_EQ(all_of(ring), (std::vector{gap, numbered(5)}));
  EXPECT_EQ(ring.gap(), std::nullopt);
  EXPECT_EQ(ring.lost_count(), 3u);
}

TEST(EventRing, of_a_closed_ring_all_that_was_not_taken_is_lost) {  // I2
  EventRing ring{4};
  for (std::uint64_t i = 0; i < 6; ++i) (void)ring.push(numbered(i));  // 2 lost
  (void)all_of(ring);
  (void)ring.push(numbered(6));  // with the gap's record
  (void)all_of(ring);
  (void)ring.push(numbered(7));
  EXPECT_EQ(ring.lost_count(), 2u);
  ring.close();
  EXPECT_EQ(ring.lost_count(), 3u);
  for (std::uint64_t i = 8; i < 21; ++i) (void)ring.push(numbered(i));
  EXPECT_EQ(ring.lost_count(), 16u);
}

TEST(EventRing, between_two_threads_nothing_is_lost_uncounted_and_nothing_torn) {  // I1, I2, I4
  constexpr std::uint64_t records = 200'000;
  EventRing ring{64};
  std::atomic<bool> done{false};
  std::thread producer{[&] {
    for (std::uint64_t i = 1; i <= records; ++i) {
      EventRecord record = numbered(i);
      record.values.fill(static_cast<std::int64_t>(i));
      (void)ring.push(record);
    }
    done = true;
  }};
  std::uint64_t expected = 1;
  std::array<EventRecord, 50> taken;
  for (bool last = false; !last;) {
    last = done;
    for (std::size_t count = ring.take(taken); count != 0; count = ring.take(taken)) {
      for (std::size_t i = 0; i < count; ++i) {
        if (taken[i].kind == EventKind::records_lost) {
          expected += static_cast<std::uint64_t>(taken[i].values[0]);
          continue;
        }
        ASSERT_EQ(taken[i].scan_number, expected);
        for (const std::int64_t value : taken[i].values)
          ASSERT_EQ(value, static_cast<std::int64_t>(expected));
        ++expected;
      }
    }
  }
  producer.join();
  EXPECT_EQ(expected + static_cast<std::uint64_t>(ring.gap().value_or(EventRecord{}).values[0]), records + 1);
}

}  // namespace
}  // namespace emulator_models::soft_plc
