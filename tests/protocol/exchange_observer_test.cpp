// Which event is told when: the memory at the moment of each event shows the step it belongs to.

#include <array>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/master_shared_memory_wrapper.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol {
namespace {

using testing::ElementsAre;

/// Writes down each event with the state word and the semaphore's count at that moment.
class Recorder final : public ExchangeObserver {
 public:
  explicit Recorder(std::string segment_name) : segment_name_(std::move(segment_name)) {}

  void submitted(std::span<const std::byte> request) noexcept override { note("submitted " + text(request)); }
  void published() noexcept override { note("published"); }
  void taken() noexcept override { note("taken"); }
  void executed(std::span<const std::byte> request) noexcept override { note("executed " + text(request)); }
  void answered(std::span<const std::byte> response) noexcept override { note("answered " + text(response)); }
  void announced() noexcept override { note("announced"); }
  void accepted() noexcept override { note("accepted"); }
  void delivered(std::span<const std::byte> response) noexcept override {
    note("delivered " + text(response));
  }
  void ended(ExchangeOutcome outcome) noexcept override {
    constexpr std::array names{"ok", "rejected", "not executed", "unknown"};
    note(std::string("ended ") + names.at(static_cast<std::size_t>(outcome)));
  }

  std::vector<std::string> events;

 private:
  void note(std::string event) {
    boost::interprocess::named_semaphore semaphore(boost::interprocess::open_only, segment_name_.c_str());
    const bool posted = semaphore.try_wait();
    if (posted) semaphore.post();
    constexpr std::array states{", idle", ", request", ", response"};
    event += states.at(RawSegment(segment_name_).word(0));
    events.push_back(event + (posted ? ", posted" : ""));
  }

  std::string segment_name_;
};

class ExchangeEvents : public testing::Test {
 protected:
  void open(const PaperOptions& options) {
    master_.emplace(segment_.name(), options, &recorder_);
    slave_.emplace(segment_.name(), options, &recorder_);
    ASSERT_TRUE(slave_->open());
    ASSERT_TRUE(master_->open());
  }

  void serve(std::string_view response) {
    ASSERT_TRUE(slave_->wait_for_request());
    static_cast<void>(slave_->read_request());
    slave_->write_response(bytes(response));
  }

  void read() {
    std::array<std::byte, 8> buffer{};
    ASSERT_TRUE(master_->get_response(buffer));
  }

  TestSegment segment_;
  Recorder recorder_{segment_.name()};
  std::optional<MasterSharedMemoryWrapper> master_;
  std::optional<SlaveSharedMemoryWrapper> slave_;
};

TEST_F(ExchangeEvents, come_in_the_order_of_the_steps) {
  open(small_options());
  ASSERT_TRUE(master_->write(bytes("ask")));
  serve("answer");
  read();
  EXPECT_THAT(recorder_.events,
              ElementsAre("submitted ask, idle", "published, request", "taken, request",
                          "executed ask, request", "answered answer, request", "announced, response",
                          "accepted, response", "delivered answer, idle", "ended ok, idle"));
}

TEST_F(ExchangeEvents, of_a_request_without_an_answer_end_in_unknown) {
  open(small_options());
  ASSERT_TRUE(master_->write(bytes("ask")));
  read();
  read();
  EXPECT_THAT(recorder_.events,
              ElementsAre("submitted ask, idle", "published, request", "ended unknown, request, posted"));
}

TEST_F(ExchangeEvents, tell_the_end_of_a_request_that_the_next_one_displaces) {
  open(small_options());
  ASSERT_TRUE(master_->write(bytes("A")));
  ASSERT_TRUE(master_->write(bytes("B")));
  EXPECT_THAT(recorder_.events,
              ElementsAre("submitted A, idle", "published, request", "ended unknown, request, posted",
                          "submitted B, request, posted", "published, request, posted"));
}

TEST_F(ExchangeEvents, tell_what_the_kernel_is_told_when_the_post_is_refused) {  // K4, H5b
  PaperOptions options = small_options();
  options.semaphore_maximum = PaperOptions::SemaphoreMaximum::one;
  open(options);
  ASSERT_TRUE(master_->write(bytes("A")));
  recorder_.events.clear();
  ASSERT_FALSE(master_->write(bytes("B")));
  EXPECT_THAT(recorder_.events,
              ElementsAre("ended unknown, request, posted", "submitted B, request, posted",
                          "published, request, posted", "ended not executed, request, posted"));
}

TEST_F(ExchangeEvents, tell_each_time_a_request_is_sent_again) {  // K8
  PaperOptions options = small_options();
  options.on_time_out = PaperOptions::OnTimeOut::send_again;
  options.send_again_count_max = 1;
  open(options);
  ASSERT_TRUE(master_->write(bytes("ask")));
  read();
  EXPECT_THAT(recorder_.events, ElementsAre("submitted ask, idle", "published, request",
                                            "published, request, posted", "ended unknown, request, posted"));
}

TEST_F(ExchangeEvents, tell_of_a_delivery_without_a_request) {  // K7, H26
  PaperOptions options = small_options();
  options.state_taken_back = PaperOptions::StateTakenBack::by_nobody;
  open(options);
  ASSERT_TRUE(master_->write(bytes("ask")));
  serve("a");
  read();
  recorder_.events.clear();
  read();
  EXPECT_THAT(recorder_.events, ElementsAre("accepted, response", "delivered a, response"));
}

TEST_F(ExchangeEvents, of_a_request_that_is_too_long_are_none) {
  open(small_options());
  ASSERT_FALSE(master_->write(bytes("123456789")));
  EXPECT_THAT(recorder_.events, ElementsAre());
}

}  // namespace
}  // namespace protocol
