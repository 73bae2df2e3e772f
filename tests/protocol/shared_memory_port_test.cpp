// The shared memory as a serial port: what a kernel that knows only SerialPort meets.

#include <array>
#include <thread>

#include <gtest/gtest.h>

#include "protocol/handoff.hpp"
#include "protocol/hardened/slave.hpp"
#include "protocol/shared_memory_port.hpp"
#include "protocol/shared_memory_port_manager.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/protocol/hardened/hardened_segment.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol {
namespace {

using namespace std::chrono_literals;

class SharedMemoryPortTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(slave_.open());
    ASSERT_TRUE(port_.open());
    port_.set_timeouts({.read = 0ns, .write = 0ns});
  }

  std::string serve(std::string_view response) {
    EXPECT_TRUE(slave_.wait_for_request());
    const std::string request = text(slave_.read_request());
    slave_.write_response(bytes(response));
    return request;
  }

  std::string read(std::size_t bytes_max) {
    std::vector<std::byte> buffer(bytes_max);
    const auto count = port_.read(buffer);
    EXPECT_TRUE(count);
    return text(std::span(buffer).first(*count));
  }

  TestSegment segment_;
  SlaveSharedMemoryWrapper slave_{segment_.name(), small_options()};
  SharedMemoryPort port_{segment_.name(), small_options()};
};

TEST_F(SharedMemoryPortTest, one_write_is_one_request_and_the_answer_is_read_back) {
  EXPECT_EQ(port_.write(bytes("ask")), 3u);
  EXPECT_EQ(serve("answer"), "ask");
  EXPECT_EQ(read(8), "answer");
}

TEST_F(SharedMemoryPortTest, gives_an_answer_in_pieces_to_a_reader_of_pieces) {
  ASSERT_TRUE(port_.write(bytes("ask")));
  serve("answer");
  EXPECT_EQ(read(1), "a");
  EXPECT_EQ(read(2), "ns");
  EXPECT_EQ(read(8), "wer");
  EXPECT_EQ(read(8), "");
}

TEST_F(SharedMemoryPortTest, keeps_the_rest_of_an_answer_over_the_next_write) {
  ASSERT_TRUE(port_.write(bytes("A")));
  serve("aaa");
  EXPECT_EQ(read(1), "a");
  ASSERT_TRUE(port_.write(bytes("B")));
  serve("bbb");
  EXPECT_EQ(read(8), "aa");
  EXPECT_EQ(read(8), "bbb");
}

TEST_F(SharedMemoryPortTest, two_writes_are_two_requests_the_second_over_the_first) {  // H22
  ASSERT_TRUE(port_.write(bytes("head")));
  ASSERT_TRUE(port_.write(bytes("body")));
  EXPECT_EQ(serve("1"), "body");
  EXPECT_EQ(serve("2"), "body");
}

TEST_F(SharedMemoryPortTest, a_time_out_is_zero_bytes_and_no_error) { EXPECT_EQ(read(8), ""); }

TEST_F(SharedMemoryPortTest, waits_for_the_read_time_out_that_was_set) {
  port_.set_timeouts({.read = 20ms, .write = 0ns});
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(read(8), "");
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 20ms);
}

TEST_F(SharedMemoryPortTest, purging_forgets_what_was_received) {
  ASSERT_TRUE(port_.write(bytes("ask")));
  serve("answer");
  EXPECT_EQ(read(1), "a");
  port_.purge();
  EXPECT_EQ(read(8), "");
}

TEST_F(SharedMemoryPortTest, purging_does_not_clear_an_answer_that_nobody_has_read) {  // H22
  ASSERT_TRUE(port_.write(bytes("ask")));
  serve("stale");
  port_.purge();
  EXPECT_EQ(read(8), "stale");
}

TEST_F(SharedMemoryPortTest, refuses_a_message_that_exceeds_the_request_area) {
  EXPECT_EQ(port_.write(bytes("123456789")), tl::make_unexpected(PortError::message_too_long));
}

TEST_F(SharedMemoryPortTest, writing_or_reading_no_bytes_does_nothing) {
  EXPECT_EQ(port_.write({}), 0u);
  EXPECT_EQ(take_all_tokens(segment_.name()), 0u);
  slave_.write_response(bytes("answer"));
  EXPECT_EQ(port_.read({}), 0u);
  EXPECT_EQ(RawSegment(segment_.name()).word(0), 2u) << "the answer still stands in the segment";
  EXPECT_EQ(read(8), "answer");
}

TEST_F(SharedMemoryPortTest, is_an_error_to_use_once_closed) {
  ASSERT_TRUE(port_.write(bytes("ask")));
  serve("answer");
  EXPECT_EQ(read(1), "a");
  port_.close();
  port_.close();
  EXPECT_FALSE(port_.is_open());
  std::array<std::byte, 8> buffer{};
  EXPECT_EQ(port_.read(buffer), tl::make_unexpected(PortError::not_open));
  EXPECT_EQ(port_.write(bytes("ask")), tl::make_unexpected(PortError::not_open));
}

TEST_F(SharedMemoryPortTest, forgets_what_was_received_when_it_is_closed) {
  ASSERT_TRUE(port_.write(bytes("ask")));
  serve("answer");
  EXPECT_EQ(read(1), "a");
  port_.close();
  ASSERT_TRUE(port_.open());
  EXPECT_EQ(read(8), "");
}

TEST(SharedMemoryPort, reports_a_segment_that_cannot_be_opened) {
  SharedMemoryPort port("no/such/folder", small_options());
  EXPECT_EQ(port.open(), tl::make_unexpected(PortError::cannot_open));
}

TEST(SharedMemoryPort, reports_a_request_whose_post_was_refused) {  // K4
  const TestSegment segment;
  PaperOptions options = small_options();
  options.semaphore_maximum = PaperOptions::SemaphoreMaximum::one;
  SharedMemoryPort port(segment.name(), options);
  ASSERT_TRUE(port.open());
  ASSERT_TRUE(port.write(bytes("A")));
  EXPECT_EQ(port.write(bytes("B")), tl::make_unexpected(PortError::refused));
}

// --- the hardened handoff, which tells how a request ended ---

class HardenedPort : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(port_.open());
    port_.set_timeouts({.read = 0ns, .write = 0ns});
  }
  tl::expected<std::size_t, PortError> read() { return port_.read(buffer_); }
  void take() {
    ASSERT_TRUE(slave_.wait_for_request());
    static_cast<void>(slave_.read_request());
  }

  hardened::HardenedSegment segment_;
  hardened::Slave slave_{segment_.name(), hardened::impatient()};
  SharedMemoryPort port_{segment_.name(), hardened::impatient()};
  std::array<std::byte, 8> buffer_{};
};

TEST_F(HardenedPort, says_that_nobody_serves) {
  EXPECT_EQ(port_.write(bytes("ask")), tl::make_unexpected(PortError::not_executed));
}

TEST_F(HardenedPort, says_that_a_request_was_withdrawn) {
  ASSERT_TRUE(slave_.open());
  ASSERT_TRUE(port_.write(bytes("ask")));
  EXPECT_EQ(read(), tl::make_unexpected(PortError::not_executed));
  EXPECT_EQ(read(), 0u) << "it is told once";
}

TEST_F(HardenedPort, says_that_a_request_was_taken_and_not_answered_and_that_the_next_one_is_not_taken) {
  ASSERT_TRUE(slave_.open());
  ASSERT_TRUE(port_.write(bytes("ask")));
  take();
  EXPECT_EQ(read(), tl::make_unexpected(PortError::unanswered));
  EXPECT_EQ(port_.write(bytes("next")), tl::make_unexpected(PortError::not_executed));
}

TEST_F(HardenedPort, says_that_who_had_taken_a_request_is_gone) {
  ASSERT_TRUE(slave_.open());
  ASSERT_TRUE(port_.write(bytes("ask")));
  take();
  slave_.close();
  ASSERT_TRUE(slave_.open());
  EXPECT_EQ(read(), tl::make_unexpected(PortError::receiver_gone));
}

TEST_F(HardenedPort, says_that_an_answer_has_no_room) {
  ASSERT_TRUE(slave_.open());
  ASSERT_TRUE(port_.write(bytes("ask")));
  take();
  slave_.write_response(bytes("123456789"));
  EXPECT_EQ(read(), tl::make_unexpected(PortError::damaged));
}

TEST_F(HardenedPort, says_that_a_damaged_request_was_not_executed) {
  ASSERT_TRUE(slave_.open());
  ASSERT_TRUE(port_.write(bytes("ask")));
  RawSegment(segment_.name()).set_text(hardened::request_offset, "?");
  std::jthread emulator([this] { EXPECT_FALSE(slave_.wait_for_request()); });
  port_.set_timeouts({.read = 60s, .write = 60s});
  while (segment_.word().phase != hardened::Phase::response) std::this_thread::yield();
  EXPECT_EQ(read(), tl::make_unexpected(PortError::not_executed));
  slave_.request_stop();
}

TEST_F(HardenedPort, gives_no_bytes_for_an_empty_answer) {
  ASSERT_TRUE(slave_.open());
  ASSERT_TRUE(port_.write(bytes("ask")));
  take();
  slave_.write_response({});
  EXPECT_EQ(read(), 0u);
}

TEST(PortErrors, that_are_in_doubt_are_three) {
  for (const PortError error : {PortError::unanswered, PortError::receiver_gone, PortError::damaged})
    EXPECT_TRUE(is_in_doubt(error)) << to_string(error);
  for (const PortError error :
       {PortError::not_open, PortError::cannot_open, PortError::already_in_use, PortError::message_too_long,
        PortError::refused, PortError::line_lost, PortError::not_executed})
    EXPECT_FALSE(is_in_doubt(error)) << to_string(error);
}

TEST(SharedMemoryPortManager, makes_ports_of_the_handoff_that_it_was_told) {
  const hardened::HardenedSegment segment;
  const TestSegment published;
  SharedMemoryPortManager hardened_ports{hardened::impatient()};
  SharedMemoryPortManager paper_ports{small_options()};
  ASSERT_TRUE((*hardened_ports.port(segment.name()))->open());
  ASSERT_TRUE((*paper_ports.port(published.name()))->open());
  EXPECT_EQ(handoff_of_segment(segment.name()), Handoff::hardened);
  EXPECT_EQ(handoff_of_segment(published.name()), Handoff::paper);
}

TEST(SharedMemoryPortManager, hands_out_one_port_for_each_name_not_opened_yet) {
  const TestSegment first;
  const TestSegment second;
  SharedMemoryPortManager ports{small_options()};
  const auto port = ports.port(first.name());
  ASSERT_TRUE(port);
  EXPECT_FALSE((*port)->is_open());
  EXPECT_EQ(*ports.port(first.name()), *port);
  EXPECT_NE(*ports.port(second.name()), *port);
}

TEST(SharedMemoryPortManager, names_the_segment_after_the_port) {
  const TestSegment segment;
  SharedMemoryPortManager ports{small_options()};
  ASSERT_TRUE((*ports.port(segment.name()))->open());
  EXPECT_TRUE(SharedMemoryWrapper::exists(segment.name()));
}

}  // namespace
}  // namespace protocol
