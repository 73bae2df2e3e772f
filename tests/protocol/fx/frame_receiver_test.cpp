// Frames from single bytes, as a serial line delivers them.
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "protocol/fx/frame.hpp"
#include "tests/protocol/fx/worked_examples.hpp"

namespace protocol::fx {
namespace {

using Event = FrameReceiver::Event;

/// Feeds all bytes; the events other than none.
std::vector<Event> feed(FrameReceiver& receiver, std::string_view hex) {
  std::vector<Event> events;
  for (const std::byte byte : examples::bytes(hex)) {
    const Event event = receiver.receive(byte);
    if (event != Event::none) events.push_back(event);
  }
  return events;
}

TEST(FxFrameReceiver, puts_every_worked_frame_together_one_after_the_other) {
  FrameReceiver receiver;
  for (const auto& example : examples::requests()) {
    EXPECT_EQ(feed(receiver, example.frame_hex), (std::vector{Event::frame})) << example.what;
    const auto wanted = examples::bytes(example.frame_hex);
    EXPECT_TRUE(std::equal(wanted.begin(), wanted.end(), receiver.frame().begin(), receiver.frame().end()));
    EXPECT_FALSE(receiver.in_frame());
  }
}

TEST(FxFrameReceiver, control_characters_between_frames_are_events) {
  FrameReceiver receiver;
  EXPECT_EQ(feed(receiver, "05 06 15"),
            (std::vector{Event::enq_received, Event::ack_received, Event::nak_received}));
}

TEST(FxFrameReceiver, stx_starts_anew_in_the_middle_of_a_frame) {
  FrameReceiver receiver;
  EXPECT_EQ(feed(receiver, "02 30 31 02 30 39 03 36 43"), (std::vector{Event::frame}));
  EXPECT_EQ(receiver.frame().size(), 6U);
}

TEST(FxFrameReceiver, stx_starts_anew_between_the_end_and_the_sum) {
  FrameReceiver receiver;
  EXPECT_EQ(feed(receiver, "02 30 39 03 36 02 30 39 03 36 43"), (std::vector{Event::frame}));
  EXPECT_EQ(receiver.frame().size(), 6U);
}

TEST(FxFrameReceiver, enq_drops_what_was_begun) {
  FrameReceiver receiver;
  EXPECT_EQ(feed(receiver, "02 30 39 05 03 36 43"), (std::vector{Event::enq_received}));
  EXPECT_FALSE(receiver.in_frame());
}

TEST(FxFrameReceiver, bytes_between_frames_are_counted_and_skipped) {
  FrameReceiver receiver;
  EXPECT_EQ(feed(receiver, "30 FF 03 02 30 39 03 36 43 0D 0A"), (std::vector{Event::frame}));
  EXPECT_EQ(receiver.skipped_bytes_count(), 5U);
}

TEST(FxFrameReceiver, a_wrong_sum_is_not_its_business) {
  FrameReceiver receiver;
  EXPECT_EQ(feed(receiver, "02 30 39 03 30 30"), (std::vector{Event::frame}));
}

TEST(FxFrameReceiver, the_longest_frame_fits_and_one_byte_more_is_dropped) {
  FrameReceiver receiver;
  receiver.receive(stx);
  for (std::size_t i = 0; i < frame_bytes_max - 4; ++i)
    EXPECT_EQ(receiver.receive(std::byte{'0'}), Event::none);
  receiver.receive(etx);
  receiver.receive(std::byte{'0'});
  EXPECT_EQ(receiver.receive(std::byte{'0'}), Event::frame);
  EXPECT_EQ(receiver.frame().size(), frame_bytes_max);

  receiver.receive(stx);
  for (std::size_t i = 0; i < frame_bytes_max - 1; ++i)
    EXPECT_EQ(receiver.receive(std::byte{'0'}), Event::none);
  EXPECT_EQ(receiver.receive(std::byte{'0'}), Event::overlong);
  EXPECT_FALSE(receiver.in_frame());
}

TEST(FxFrameReceiver, reset_says_whether_a_frame_was_cut_off) {
  FrameReceiver receiver;
  EXPECT_FALSE(receiver.reset());
  feed(receiver, "02 30");
  EXPECT_TRUE(receiver.in_frame());
  EXPECT_TRUE(receiver.reset());
  EXPECT_FALSE(receiver.in_frame());
  EXPECT_EQ(feed(receiver, "39 03 36 43"), std::vector<Event>{});
}

TEST(FxFrameReceiver, a_whole_frame_is_valid_until_the_next_byte) {
  FrameReceiver receiver;
  feed(receiver, "02 30 39 03 36 43");
  EXPECT_EQ(receiver.frame().size(), 6U);
  receiver.receive(std::byte{0x30});
  EXPECT_TRUE(receiver.frame().empty());
}

}  // namespace
}  // namespace protocol::fx
