#include "emulator_models/soft_plc/signal_recorder.hpp"

#include <array>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace emulator_models::soft_plc {
namespace {

std::vector<EventRecord> taken(EventRing& ring) {
  std::vector<EventRecord> records(ring.capacity());
  records.resize(ring.take(records));
  return records;
}

TEST(SignalRecorder, each_change_of_a_chosen_bit_is_a_record_and_no_other) {
  EventRing ring{64};
  SignalRecorder recorder{ring, 2, std::vector<std::size_t>{17, 3}};
  std::array<std::byte, 4> image{};
  recorder.observe(image, 1, 100);
  image[2] = std::byte{0b0000'0011};  // bits 16 and 17
  recorder.observe(image, 2, 200);
  recorder.observe(image, 3, 300);
  image[0] = std::byte{0xFF};  // bit 3 among others
  image[2] = std::byte{0};
  recorder.observe(image, 4, 400);
  const auto change = [](std::uint16_t signal, std::int64_t before, std::int64_t after, std::uint64_t scan) {
    return EventRecord{.kind = EventKind::signal_change,
                       .cycle = 2,
                       .code = signal,
                       .time_ns = static_cast<std::int64_t>(scan) * 100,
                       .scan_number = scan,
                       .values = {before, after}};
  };
  EXPECT_EQ(taken(ring), (std::vector{change(0, 0, 1, 2), change(0, 1, 0, 4), change(1, 0, 1, 4)}));
}

TEST(SignalRecorder, the_first_image_is_no_change) {
  EventRing ring{64};
  SignalRecorder recorder{ring, 0, std::vector<std::size_t>{0, 1}};
  const std::array image{std::byte{0xFF}};
  recorder.observe(image, 1, 0);
  EXPECT_TRUE(taken(ring).empty());
}

TEST(SignalRecorder, a_bit_beyond_the_image_is_0) {
  EventRing ring{64};
  SignalRecorder recorder{ring, 0, std::vector<std::size_t>{7, 8, std::size_t{1} << 40}};
  const std::array image{std::byte{0}, std::byte{0}};
  recorder.observe(image, 1, 0);
  recorder.observe(std::array{std::byte{0x80}}, 2, 0);
  const auto records = taken(ring);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].code, 0);
}

TEST(SignalRecorder, signals_beyond_the_bound_are_ignored) {
  EventRing ring{1024};
  std::vector<std::size_t> all(SignalRecorder::signals_max + 1);
  std::iota(all.begin(), all.end(), std::size_t{0});
  SignalRecorder recorder{ring, 0, all};
  std::vector<std::byte> image(SignalRecorder::signals_max / 8 + 1);
  recorder.observe(image, 1, 0);
  image.assign(image.size(), std::byte{0xFF});
  recorder.observe(image, 2, 0);
  EXPECT_EQ(taken(ring).size(), SignalRecorder::signals_max);
}

TEST(SignalRecorder, what_finds_no_room_is_lost_and_counted_and_the_next_change_is_right) {
  EventRing ring{2};
  SignalRecorder recorder{ring, 0, std::vector<std::size_t>{0}};
  for (unsigned scan = 0; scan <= 10; ++scan) recorder.observe(std::array{std::byte(scan % 2)}, scan, 0);
  EXPECT_EQ(ring.lost_count(), 8U);
  (void)taken(ring);
  recorder.observe(std::array{std::byte{1}}, 11, 0);
  const auto records = taken(ring);
  ASSERT_EQ(records.size(), 2U);
  EXPECT_EQ(records[0].kind, EventKind::records_lost);
  EXPECT_EQ(records[1].values, (std::array<std::int64_t, 5>{0, 1}));
}

}  // namespace
}  // namespace emulator_models::soft_plc
