// One exchange, step by step in one thread: what stands in the memory after each step, and what each open
// question (K1 to K4, K6 to K9) and the order of the answer (K12) change. The hazards that need only the order of whole calls are here too.

#include <array>
#include <fstream>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include <unistd.h>

#include "protocol/master_shared_memory_wrapper.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t state = 0;
constexpr std::size_t request_length = 4;
constexpr std::size_t request_bytes = 8;
constexpr std::size_t response_length = 16;
constexpr std::size_t response_bytes = 20;

/// Both sides on a segment of their own, and the memory between them.
class Exchange {
 public:
  explicit Exchange(const PaperOptions& options)
      : master(segment.name(), options), slave(segment.name(), options) {
    EXPECT_TRUE(slave.open());
    EXPECT_TRUE(master.open());
    memory.emplace(segment.name());
  }

  /// The slave's whole turn; a token must be there.
  /// @return the request that it executed
  std::string serve(std::string_view response) {
    EXPECT_TRUE(slave.wait_for_request());
    const std::string request = text(slave.read_request());
    slave.write_response(bytes(response));
    return request;
  }

  /// @return the answer; "" when there is none
  std::string read() {
    std::array<std::byte, 64> buffer{};
    const auto length = master.get_response(buffer);
    EXPECT_TRUE(length);
    return text(std::span(buffer).first(*length));
  }

  [[nodiscard]] unsigned tokens() const { return take_all_tokens(segment.name()); }

  TestSegment segment;
  MasterSharedMemoryWrapper master;
  SlaveSharedMemoryWrapper slave;
  std::optional<RawSegment> memory;
};

TEST(Exchange, a_request_is_length_bytes_state_and_one_post) {
  Exchange exchange(small_options());
  ASSERT_TRUE(exchange.master.write(bytes("ask")));
  EXPECT_EQ(exchange.memory->word(request_length), 3u);
  EXPECT_EQ(exchange.memory->text(request_bytes, 3), "ask");
  EXPECT_EQ(exchange.memory->word(state), 1u);
  EXPECT_EQ(exchange.tokens(), 1u);
}

TEST(Exchange, the_slave_takes_the_post_and_leaves_the_state) {
  Exchange exchange(small_options());
  ASSERT_TRUE(exchange.master.write(bytes("ask")));
  ASSERT_TRUE(exchange.slave.wait_for_request());
  EXPECT_EQ(text(exchange.slave.read_request()), "ask");
  EXPECT_EQ(exchange.memory->word(state), 1u);
  EXPECT_EQ(exchange.tokens(), 0u);
}

TEST(Exchange, a_response_is_length_bytes_and_state) {
  Exchange exchange(small_options());
  exchange.slave.write_response(bytes("answer"));
  EXPECT_EQ(exchange.memory->word(response_length), 6u);
  EXPECT_EQ(exchange.memory->text(response_bytes, 6), "answer");
  EXPECT_EQ(exchange.memory->word(state), 2u);
  EXPECT_EQ(exchange.tokens(), 0u);
}

TEST(Exchange, reading_the_answer_takes_the_state_back) {
  Exchange exchange(small_options());
  ASSERT_TRUE(exchange.master.write(bytes("ask")));
  EXPECT_EQ(exchange.serve("answer"), "ask");
  EXPECT_EQ(exchange.read(), "answer");
  EXPECT_EQ(exchange.memory->word(state), 0u);
  EXPECT_EQ(exchange.read(), "");
}

TEST(Exchange, a_request_may_be_empty_or_fill_its_area_and_not_more) {
  Exchange exchange(small_options());
  ASSERT_TRUE(exchange.master.write({}));
  EXPECT_EQ(exchange.serve(""), "");
  ASSERT_TRUE(exchange.master.write(bytes("12345678")));
  EXPECT_EQ(exchange.serve("12345678"), "12345678");
  EXPECT_EQ(exchange.read(), "12345678");
  EXPECT_EQ(exchange.master.write(bytes("123456789")),
            tl::make_unexpected(SharedMemoryError::request_too_long));
  EXPECT_EQ(exchange.tokens(), 0u);
}

TEST(Exchange, a_response_that_exceeds_its_area_is_cut_off) {
  Exchange exchange(small_options());
  exchange.slave.write_response(bytes("123456789"));
  EXPECT_EQ(exchange.read(), "12345678");
}

TEST(Exchange, needs_open_wrappers) {
  MasterSharedMemoryWrapper master("never-opened", small_options());
  EXPECT_EQ(master.write(bytes("ask")), tl::make_unexpected(SharedMemoryError::not_open));
  EXPECT_EQ(master.get_response({}), tl::make_unexpected(SharedMemoryError::not_open));
}

TEST(ReadWait, polling_returns_nothing_before_the_answer) {  // K1
  Exchange exchange(small_options());
  exchange.memory->set_word(response_length, 3);
  exchange.memory->set_text(response_bytes, "old");
  ASSERT_TRUE(exchange.master.write(bytes("ask")));
  EXPECT_EQ(exchange.read(), "");
}

TEST(ReadWait, reading_immediately_returns_the_answer_to_something_else) {  // K1, H1
  PaperOptions options = small_options();
  options.read_wait = PaperOptions::ReadWait::immediately;
  Exchange exchange(options);
  ASSERT_TRUE(exchange.master.write(bytes("A")));
  EXPECT_EQ(exchange.serve("answer A"), "A");
  ASSERT_TRUE(exchange.master.write(bytes("B")));
  EXPECT_EQ(exchange.read(), "answer A");
}

TEST(ReadWait, reading_immediately_leaves_the_state) {  // K1: r2 r3 only
  PaperOptions options = small_options();
  options.read_wait = PaperOptions::ReadWait::immediately;
  Exchange exchange(options);
  exchange.slave.write_response(bytes("answer"));
  EXPECT_EQ(exchange.read(), "answer");
  EXPECT_EQ(exchange.memory->word(state), 2u);
}

PaperOptions halves() {
  PaperOptions options = small_options();
  options.state_coding = PaperOptions::StateCoding::halves;
  return options;
}

TEST(StateInHalves, each_step_changes_its_own_half) {  // K2
  Exchange exchange(halves());
  ASSERT_TRUE(exchange.master.write(bytes("ask")));
  EXPECT_EQ(exchange.memory->word(state), 0x0000'0001u);
  EXPECT_EQ(exchange.serve("answer"), "ask");
  EXPECT_EQ(exchange.memory->word(state), 0x0001'0000u);
  EXPECT_EQ(exchange.read(), "answer");
  EXPECT_EQ(exchange.memory->word(state), 0u);
}

TEST(StateInHalves, a_request_does_not_wipe_an_answer_that_was_not_read) {  // K2
  Exchange exchange(halves());
  exchange.slave.write_response(bytes("A"));
  ASSERT_TRUE(exchange.master.write(bytes("B")));
  EXPECT_EQ(exchange.memory->word(state), 0x0001'0001u);
  EXPECT_EQ(exchange.read(), "A");
  EXPECT_EQ(exchange.memory->word(state), 0x0000'0001u);
}

TEST(SemaphoreAfterAnswer, waiting_leaves_a_post_that_came_meanwhile) {  // K3
  Exchange exchange(small_options());
  ASSERT_TRUE(exchange.master.write(bytes("A")));
  ASSERT_TRUE(exchange.slave.wait_for_request());
  ASSERT_TRUE(exchange.master.write(bytes("B")));
  exchange.slave.write_response(bytes("a"));
  EXPECT_EQ(exchange.tokens(), 1u);
}

TEST(SemaphoreAfterAnswer, resetting_wipes_every_post_that_came_meanwhile) {  // K3, H6
  PaperOptions options = small_options();
  options.semaphore_after_answer = PaperOptions::SemaphoreAfterAnswer::reset;
  Exchange exchange(options);
  ASSERT_TRUE(exchange.master.write(bytes("A")));
  ASSERT_TRUE(exchange.slave.wait_for_request());
  ASSERT_TRUE(exchange.master.write(bytes("B")));
  ASSERT_TRUE(exchange.master.write(bytes("C")));
  exchange.slave.write_response(bytes("a"));
  EXPECT_EQ(exchange.tokens(), 0u);
}

TEST(SemaphoreMaximum, large_counts_every_post) {  // K4, H9
  Exchange exchange(small_options());
  ASSERT_TRUE(exchange.master.write(bytes("A")));
  ASSERT_TRUE(exchange.master.write(bytes("B")));
  EXPECT_EQ(exchange.serve(""), "B");
  EXPECT_EQ(exchange.serve(""), "B");
}

TEST(SemaphoreMaximum, one_refuses_the_post_of_a_request_that_is_then_executed) {  // K4, H5b
  PaperOptions options = small_options();
  options.semaphore_maximum = PaperOptions::SemaphoreMaximum::one;
  Exchange exchange(options);
  ASSERT_TRUE(exchange.master.write(bytes("A")));
  EXPECT_EQ(exchange.master.write(bytes("B")), tl::make_unexpected(SharedMemoryError::semaphore_full));
  EXPECT_EQ(exchange.serve(""), "B");
  EXPECT_EQ(exchange.tokens(), 0u);
}

TEST(SemaphoreMaximum, one_accepts_the_post_again_once_the_first_is_consumed) {  // K4
  PaperOptions options = small_options();
  options.semaphore_maximum = PaperOptions::SemaphoreMaximum::one;
  Exchange exchange(options);
  ASSERT_TRUE(exchange.master.write(bytes("A")));
  EXPECT_EQ(exchange.serve(""), "A");
  EXPECT_TRUE(exchange.master.write(bytes("B")));
}

class InEitherOrder : public testing::TestWithParam<PaperOptions::AreaOrder> {};

TEST_P(InEitherOrder, both_areas_carry_what_was_written) {  // K6
  PaperOptions options = small_options();
  options.area_order = GetParam();
  Exchange exchange(options);
  ASSERT_TRUE(exchange.master.write(bytes("long ask")));
  EXPECT_EQ(exchange.serve("a"), "long ask");
  EXPECT_EQ(exchange.read(), "a");
  ASSERT_TRUE(exchange.master.write(bytes("B")));
  EXPECT_EQ(exchange.serve("answer B"), "B");
  EXPECT_EQ(exchange.read(), "answer B");
}

INSTANTIATE_TEST_SUITE_P(K6, InEitherOrder,
                         testing::Values(PaperOptions::AreaOrder::length_first,
                                         PaperOptions::AreaOrder::bytes_first));

TEST(StateTakenBack, by_nobody_the_same_answer_is_delivered_twice) {  // K7, H26
  PaperOptions options = small_options();
  options.state_taken_back = PaperOptions::StateTakenBack::by_nobody;
  Exchange exchange(options);
  ASSERT_TRUE(exchange.master.write(bytes("ask")));
  EXPECT_EQ(exchange.serve("answer"), "ask");
  EXPECT_EQ(exchange.read(), "answer");
  EXPECT_EQ(exchange.read(), "answer");
}

TEST(OnTimeOut, giving_up_leaves_the_late_answer_to_the_next_request) {  // K8, H3
  Exchange exchange(small_options());
  ASSERT_TRUE(exchange.master.write(bytes("A")));
  ASSERT_TRUE(exchange.slave.wait_for_request());
  EXPECT_EQ(text(exchange.slave.read_request()), "A");
  EXPECT_EQ(exchange.read(), "");
  ASSERT_TRUE(exchange.master.write(bytes("B")));
  exchange.slave.write_response(bytes("answer A"));
  EXPECT_EQ(exchange.read(), "answer A");
}

TEST(OnTimeOut, sending_again_posts_the_same_request_as_often_as_allowed) {  // K8, H13
  PaperOptions options = small_options();
  options.on_time_out = PaperOptions::OnTimeOut::send_again;
  options.send_again_count_max = 3;
  Exchange exchange(options);
  ASSERT_TRUE(exchange.master.write(bytes("ask")));
  EXPECT_EQ(exchange.read(), "");
  EXPECT_EQ(exchange.memory->text(request_bytes, 3), "ask");
  EXPECT_EQ(exchange.tokens(), 4u);
}

TEST(OnTimeOut, nothing_is_sent_again_when_nothing_was_asked) {  // K8
  PaperOptions options = small_options();
  options.on_time_out = PaperOptions::OnTimeOut::send_again;
  Exchange exchange(options);
  EXPECT_EQ(exchange.read(), "");
  EXPECT_EQ(exchange.tokens(), 0u);
}

TEST(OnTimeOut, is_never_early) {  // I16
  PaperOptions options = small_options();
  options.read_timeout = 20ms;
  Exchange exchange(options);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(exchange.read(), "");
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 20ms);
}

TEST(OnTimeOut, a_time_out_beyond_the_end_of_the_clock_is_not_a_time_out_at_once) {  // H25
  PaperOptions options = small_options();
  options.read_timeout = std::chrono::nanoseconds::max();
  Exchange exchange(options);
  std::jthread late([&exchange] {
    std::this_thread::sleep_for(2ms);
    exchange.slave.write_response(bytes("late"));
  });
  EXPECT_EQ(exchange.read(), "late");
}

TEST(LengthCheck, without_one_a_foreign_length_copies_what_lies_beyond_the_area) {  // K9, H21
  Exchange exchange(small_options());
  ASSERT_TRUE(exchange.master.write(bytes("12345678")));
  exchange.memory->set_word(request_length, 1000);
  exchange.memory->set_word(response_length, 0x64636261);
  ASSERT_TRUE(exchange.slave.wait_for_request());
  const std::string request = text(exchange.slave.read_request());
  EXPECT_EQ(request.size(), 20u) << "the copy ends where the mapped memory ends";
  EXPECT_EQ(request.substr(0, 12), "12345678abcd");
}

TEST(LengthCheck, without_one_the_copy_ends_at_the_readers_buffer) {  // K9
  Exchange exchange(small_options());
  exchange.slave.write_response(bytes("answer"));
  exchange.memory->set_word(response_length, 0xFFFF'FFFF);
  std::array<std::byte, 4> buffer{};
  EXPECT_EQ(exchange.master.get_response(buffer), 4u);
  EXPECT_EQ(text(buffer), "answ");
}

class CheckedLength : public testing::TestWithParam<PaperOptions::LengthCheck> {};

TEST_P(CheckedLength, takes_a_message_with_a_foreign_length_for_empty) {  // K9
  PaperOptions options = small_options();
  options.length_check = GetParam();
  Exchange exchange(options);
  ASSERT_TRUE(exchange.master.write(bytes("12345678")));
  exchange.memory->set_word(request_length, 9);
  EXPECT_EQ(exchange.serve("answer"), "");
  exchange.memory->set_word(response_length, 9);
  EXPECT_EQ(exchange.read(), "");
}

TEST_P(CheckedLength, takes_a_message_that_fills_its_area) {  // K9
  PaperOptions options = small_options();
  options.length_check = GetParam();
  Exchange exchange(options);
  ASSERT_TRUE(exchange.master.write(bytes("12345678")));
  EXPECT_EQ(exchange.serve("87654321"), "12345678");
  EXPECT_EQ(exchange.read(), "87654321");
}

INSTANTIATE_TEST_SUITE_P(K9, CheckedLength,
                         testing::Values(PaperOptions::LengthCheck::check_and_load_again,
                                         PaperOptions::LengthCheck::load_once));

class OrderedAnswer : public testing::TestWithParam<PaperOptions::StateCoding> {};

TEST_P(OrderedAnswer, leaves_every_step_as_it_is) {  // K12: the order of memory shows in one thread to nobody
  PaperOptions as_published = small_options();
  as_published.state_coding = GetParam();
  PaperOptions ordered = as_published;
  ordered.answer_order = PaperOptions::AnswerOrder::release_and_acquire;
  Exchange exchange(ordered);
  Exchange reference(as_published);
  const auto expect_the_same_word = [&] {
    EXPECT_EQ(exchange.memory->word(state), reference.memory->word(state));
  };
  for (Exchange* each : {&exchange, &reference}) ASSERT_TRUE(each->master.write(bytes("ask")));
  expect_the_same_word();
  for (Exchange* each : {&exchange, &reference}) EXPECT_EQ(each->serve("answer"), "ask");
  expect_the_same_word();
  for (Exchange* each : {&exchange, &reference}) EXPECT_EQ(each->read(), "answer");
  expect_the_same_word();
}

INSTANTIATE_TEST_SUITE_P(K12, OrderedAnswer,
                         testing::Values(PaperOptions::StateCoding::enumeration,
                                         PaperOptions::StateCoding::halves));

TEST(Stopping, a_slave_does_not_execute_what_is_pending) {  // H19 does not follow
  Exchange exchange(small_options());
  ASSERT_TRUE(exchange.master.write(bytes("ask")));
  exchange.slave.request_stop();
  EXPECT_FALSE(exchange.slave.wait_for_request());
  EXPECT_FALSE(exchange.slave.wait_for_request());
  EXPECT_EQ(exchange.tokens(), 1u) << "the post of the pending request is still there, and no other";
}

TEST(Stopping, leaves_no_post_behind_however_often_it_is_requested) {  // H11 does not follow
  Exchange exchange(small_options());
  exchange.slave.request_stop();
  exchange.slave.request_stop();
  EXPECT_FALSE(exchange.slave.wait_for_request());
  EXPECT_EQ(exchange.tokens(), 0u);
}

/// @return whether the system has put the thread to sleep
bool is_asleep(pid_t thread) {
  std::ifstream status("/proc/self/task/" + std::to_string(thread) + "/stat");
  std::string number, name, run_state;
  return status >> number >> name >> run_state && run_state == "S";
}

TEST(Stopping, frees_a_slave_that_waits) {
  Exchange exchange(small_options());
  std::jthread stopper([&exchange, waiting_thread = ::gettid()] {
    while (!is_asleep(waiting_thread)) std::this_thread::yield();
    exchange.slave.request_stop();
  });
  EXPECT_FALSE(exchange.slave.wait_for_request());
  EXPECT_EQ(exchange.tokens(), 0u);
}

}  // namespace
}  // namespace protocol
