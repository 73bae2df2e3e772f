// Whole exchanges over real objects, one call after the other: what the word says between them, how each request ends,
// and what of the other side's doing is refused. No call waits.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>

#include "protocol/hardened/master.hpp"
#include "protocol/hardened/slave.hpp"
#include "tests/protocol/hardened/hardened_segment.hpp"

namespace protocol::hardened {
namespace {

using testing::ElementsAre;

/// Stops a slave as soon as it has answered something.
class StopsAfterAnswer final : public ExchangeObserver {
 public:
  void of(Slave& slave) noexcept { slave_ = &slave; }
  void announced() noexcept override {
    if (slave_ != nullptr) slave_->request_stop();
  }

 private:
  Slave* slave_ = nullptr;
};

class HardenedExchange : public testing::Test {
 protected:
  void open(const Options& options = impatient()) {
    slave_.emplace(segment_.name(), options, &refusal_);
    ASSERT_TRUE(slave_->open());
    open_master(options);
  }
  void open_master(const Options& options = impatient()) {
    master_.reset();
    master_.emplace(segment_.name(), options);
    ASSERT_TRUE(master_->open());
  }
  void restart_slave() {
    // As after a kill: nothing is stopped in good order.
    const StateWord word = segment_.word();
    slave_->close();
    segment_.set_word(word);
    const Options options = slave_->options();
    slave_.emplace(segment_.name(), options, &refusal_);
    ASSERT_TRUE(slave_->open());
  }

  void serve(std::string_view response) {
    ASSERT_TRUE(slave_->wait_for_request());
    executed_.push_back(text(slave_->read_request()));
    slave_->write_response(bytes(response));
  }
  /// The slave answers what it has taken, and does not execute it.
  void expect_answered_unexecuted() {
    refusal_.of(*slave_);
    EXPECT_FALSE(slave_->wait_for_request());
  }

  std::string read(std::size_t room = 8) {
    std::vector<std::byte> into(room);
    const auto count = master_->get_response(into);
    return count ? text(std::span(into).first(*count)) : std::string(to_string(count.error()));
  }
  void expect_no_answer(ExchangeOutcome outcome, SharedMemoryError why) {
    EXPECT_EQ(read(), to_string(why));
    EXPECT_EQ(master_->last_outcome(), outcome);
  }
  void ring(const char* which) const {
    Doorbell bell;
    ASSERT_TRUE(bell.open(segment_.name() + which));
    bell.ring();
  }
  std::uint32_t raw(std::size_t offset) const { return RawSegment(segment_.name()).word(offset); }

  HardenedSegment segment_;
  StopsAfterAnswer refusal_;
  std::optional<Slave> slave_;
  std::optional<Master> master_;
  std::vector<std::string> executed_;
};

TEST_F(HardenedExchange, brings_the_answer_to_its_request) {
  open();
  for (const std::string number : {"1", "2", "3"}) {
    ASSERT_TRUE(master_->write(bytes("ask " + number)));
    serve("got " + number);
    EXPECT_EQ(read(), "got " + number);
    EXPECT_EQ(master_->last_outcome(), ExchangeOutcome::ok);
  }
  EXPECT_THAT(executed_, ElementsAre("ask 1", "ask 2", "ask 3"));
}

TEST_F(HardenedExchange, leads_the_word_from_idle_over_request_busy_and_response_to_idle) {
  open();
  const StateWord idle = segment_.word();
  EXPECT_EQ(idle, (StateWord{Phase::idle, 2, 0}));  // two attaches
  ASSERT_TRUE(master_->write(bytes("ask")));
  EXPECT_EQ(segment_.word(), (StateWord{Phase::request, 2, 1}));
  EXPECT_EQ(raw(request_length_offset), header_bytes + 3);
  ASSERT_TRUE(slave_->wait_for_request());
  EXPECT_EQ(segment_.word(), (StateWord{Phase::busy, 2, 1}));
  static_cast<void>(slave_->read_request());
  slave_->write_response(bytes("answer"));
  EXPECT_EQ(segment_.word(), (StateWord{Phase::response, 2, 1}));
  EXPECT_EQ(raw(response_length_offset), header_bytes + 6);
  EXPECT_EQ(read(), "answer");
  EXPECT_EQ(segment_.word(), (StateWord{Phase::idle, 2, 1}));
}

TEST_F(HardenedExchange, carries_payloads_of_no_bytes_and_of_as_many_as_have_room) {
  open();
  ASSERT_TRUE(master_->write({}));
  serve("");
  EXPECT_EQ(read(), "");
  EXPECT_EQ(master_->last_outcome(), ExchangeOutcome::ok);
  ASSERT_TRUE(master_->write(bytes("12345678")));
  serve("abcdefgh");
  EXPECT_EQ(read(), "abcdefgh");
  EXPECT_THAT(executed_, ElementsAre("", "12345678"));
}

TEST_F(HardenedExchange, refuses_a_request_that_is_one_byte_too_long_and_touches_nothing) {
  open();
  EXPECT_EQ(master_->write(bytes("123456789")), tl::unexpected(SharedMemoryError::request_too_long));
  EXPECT_EQ(segment_.word(), (StateWord{Phase::idle, 2, 0}));
}

TEST_F(HardenedExchange, ends_unknown_when_the_answer_has_no_room) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  serve("123456789");
  expect_no_answer(ExchangeOutcome::unknown, SharedMemoryError::damaged);
  EXPECT_EQ(segment_.word().phase, Phase::idle);
}

TEST_F(HardenedExchange, cuts_an_answer_to_the_readers_room) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  serve("answer");
  EXPECT_EQ(read(3), "ans");
}

TEST_F(HardenedExchange, needs_no_wait_once_it_is_answered_however_late) {
  open();
  const auto result = [&] {
    EXPECT_TRUE(master_->write(bytes("ask")));
    serve("late");
    return read();
  }();
  EXPECT_EQ(result, "late");
}

// --- time-outs ---

TEST_F(HardenedExchange, withdraws_what_nobody_has_taken) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  expect_no_answer(ExchangeOutcome::not_executed, SharedMemoryError::not_executed);
  EXPECT_EQ(segment_.word(), (StateWord{Phase::idle, 2, 1}));
}

TEST_F(HardenedExchange, gives_up_what_was_taken_and_its_outcome_is_unknown) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  ASSERT_TRUE(slave_->wait_for_request());
  expect_no_answer(ExchangeOutcome::unknown, SharedMemoryError::unanswered);
  EXPECT_EQ(segment_.word(), (StateWord{Phase::orphan, 2, 1}));
  EXPECT_EQ(master_->write(bytes("next")), tl::unexpected(SharedMemoryError::slave_is_busy));
  EXPECT_EQ(master_->last_outcome(), ExchangeOutcome::not_executed);
  static_cast<void>(slave_->read_request());
  slave_->write_response(bytes("late"));
  EXPECT_EQ(segment_.word(), (StateWord{Phase::idle, 2, 1}));
  ASSERT_TRUE(master_->write(bytes("next")));
  serve("own");
  EXPECT_EQ(read(), "own");
}

TEST_F(HardenedExchange, answers_a_request_that_comes_again_from_the_store) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  serve("answer");
  // Published once more, as a query would be.
  segment_.set_word({Phase::request, 2, 1});
  ring(".request");
  expect_answered_unexecuted();
  EXPECT_EQ(read(), "answer");
  EXPECT_THAT(executed_, ElementsAre("ask"));
}

TEST_F(HardenedExchange, of_a_request_that_another_displaces_ends_before_the_next_begins) {
  open();
  ASSERT_TRUE(master_->write(bytes("one")));
  ASSERT_TRUE(master_->write(bytes("two")));
  EXPECT_EQ(segment_.word(), (StateWord{Phase::request, 2, 2}));
  serve("two!");
  EXPECT_EQ(read(), "two!");
  EXPECT_THAT(executed_, ElementsAre("two"));
}

TEST_F(HardenedExchange, of_nothing_gets_nothing) {
  open();
  EXPECT_EQ(read(), "");
  EXPECT_EQ(segment_.word(), (StateWord{Phase::idle, 2, 0}));
}

// --- without a slave, and with another one ---

TEST_F(HardenedExchange, without_a_slave_ends_at_once_and_is_not_executed) {
  open_master();
  EXPECT_EQ(master_->write(bytes("ask")), tl::unexpected(SharedMemoryError::no_slave));
  EXPECT_EQ(master_->last_outcome(), ExchangeOutcome::not_executed);
  EXPECT_EQ(segment_.word(), StateWord{});
}

TEST_F(HardenedExchange, with_a_slave_that_stops_is_dropped_untaken) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  slave_->close();
  EXPECT_EQ(segment_.word(), (StateWord{Phase::down, 2, 1}));
  expect_no_answer(ExchangeOutcome::not_executed, SharedMemoryError::not_executed);
  EXPECT_EQ(master_->write(bytes("ask")), tl::unexpected(SharedMemoryError::no_slave));
}

TEST_F(HardenedExchange, with_a_slave_that_stops_after_its_answer_is_answered) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  serve("answer");
  slave_->close();
  EXPECT_EQ(read(), "answer");
}

TEST_F(HardenedExchange, that_nobody_took_is_dropped_by_the_next_slave) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  restart_slave();
  expect_no_answer(ExchangeOutcome::not_executed, SharedMemoryError::not_executed);
  EXPECT_EQ(segment_.word(), (StateWord{Phase::idle, 3, 1}));
}

TEST_F(HardenedExchange, that_a_dead_slave_had_taken_is_lost_and_its_outcome_unknown) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  ASSERT_TRUE(slave_->wait_for_request());
  restart_slave();
  EXPECT_EQ(segment_.word(), (StateWord{Phase::lost, 3, 1}));
  expect_no_answer(ExchangeOutcome::unknown, SharedMemoryError::slave_gone);
  EXPECT_EQ(segment_.word(), (StateWord{Phase::idle, 3, 1}));
}

TEST_F(HardenedExchange, that_a_dead_slave_had_answered_is_answered) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  serve("answer");
  restart_slave();
  EXPECT_EQ(segment_.word(), (StateWord{Phase::response, 3, 1}));
  EXPECT_EQ(read(), "answer");
  // Who has answered is not who serves now.
  ASSERT_TRUE(master_->write(bytes("next")));
  serve("own");
  EXPECT_EQ(read(), "own");
}

TEST_F(HardenedExchange, that_was_lost_is_acknowledged_by_the_next_request) {
  open();
  segment_.set_word({Phase::lost, 2, 0});
  ASSERT_TRUE(master_->write(bytes("ask")));
  EXPECT_EQ(segment_.word(), (StateWord{Phase::request, 2, 1}));
}

TEST_F(HardenedExchange, of_a_dead_master_ends_with_the_next_one) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  const StateWord request = segment_.word();
  master_->close();
  segment_.set_word(request);
  open_master();
  EXPECT_EQ(segment_.word(), (StateWord{Phase::idle, 3, 1}));
}

TEST_F(HardenedExchange, that_is_under_way_when_the_master_closes_is_withdrawn) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  master_->close();
  EXPECT_EQ(segment_.word(), (StateWord{Phase::idle, 2, 1}));
}

TEST_F(HardenedExchange, goes_on_where_generation_and_sequence_wrap) {
  Options options = impatient();
  options.first_sequence = 0xFFFF;
  open(options);
  segment_.set_word({Phase::idle, StateWord::generation_max, 0xFFFE});
  ASSERT_TRUE(master_->write(bytes("one")));
  EXPECT_EQ(segment_.word(), (StateWord{Phase::request, StateWord::generation_max, 0xFFFF}));
  serve("1");
  EXPECT_EQ(read(), "1");
  restart_slave();
  EXPECT_EQ(segment_.word(), (StateWord{Phase::idle, 0, 0xFFFF}));
  ASSERT_TRUE(master_->write(bytes("two")));
  EXPECT_EQ(segment_.word(), (StateWord{Phase::request, 0, 0}));
  serve("2");
  EXPECT_EQ(read(), "2");
}

TEST_F(HardenedExchange, is_refused_by_a_slave_that_came_when_the_generation_had_gone_all_the_way_round) {
  open();
  ASSERT_TRUE(master_->write(bytes("one")));
  serve("1");
  EXPECT_EQ(read(), "1");
  restart_slave();
  StateWord word = segment_.word();
  word.generation = 2;  // as 2^13 attaches later
  segment_.set_word(word);
  ASSERT_TRUE(master_->write(bytes("two")));
  expect_answered_unexecuted();
  expect_no_answer(ExchangeOutcome::rejected, SharedMemoryError::rejected);
  EXPECT_THAT(executed_, ElementsAre("one"));
}

// --- bytes that nobody should have written ---

/// What the slave does with a request whose area was altered after it was published.
class AlteredRequest : public HardenedExchange {
 protected:
  template <typename Alter>
  void expect_rejected(Alter alter) {
    open();
    ASSERT_TRUE(master_->write(bytes("ask")));
    RawSegment memory(segment_.name());
    alter(memory);
    expect_answered_unexecuted();
    expect_no_answer(ExchangeOutcome::rejected, SharedMemoryError::rejected);
    EXPECT_EQ(segment_.word().phase, Phase::idle);
  }
};

TEST_F(AlteredRequest, in_its_payload_is_rejected) {
  expect_rejected([](RawSegment& memory) { memory.set_text(request_offset + header_bytes, "b"); });
}
TEST_F(AlteredRequest, whose_length_is_below_a_header_is_rejected) {
  expect_rejected([](RawSegment& memory) { memory.set_word(request_length_offset, header_bytes - 1); });
}
TEST_F(AlteredRequest, whose_length_is_beyond_its_area_is_rejected) {
  expect_rejected([](RawSegment& memory) { memory.set_word(request_length_offset, header_bytes + 9); });
}
TEST_F(AlteredRequest, whose_length_is_as_large_as_can_be_is_rejected) {
  expect_rejected([](RawSegment& memory) { memory.set_word(request_length_offset, 0xFFFF'FFFF); });
}
TEST_F(AlteredRequest, whose_length_is_that_of_the_area_and_not_its_own_is_rejected) {
  expect_rejected([](RawSegment& memory) { memory.set_word(request_length_offset, header_bytes + 8); });
}

/// What the master does with an answer whose area was altered after it was published.
class AlteredResponse : public HardenedExchange {
 protected:
  template <typename Alter>
  void expect_unknown(Alter alter) {
    open();
    ASSERT_TRUE(master_->write(bytes("ask")));
    serve("answer");
    RawSegment memory(segment_.name());
    alter(memory);
    expect_no_answer(ExchangeOutcome::unknown, SharedMemoryError::damaged);
    EXPECT_EQ(segment_.word().phase, Phase::idle);
    ASSERT_TRUE(master_->write(bytes("next")));
    serve("own");
    EXPECT_EQ(read(), "own");
  }
  /// A message from elsewhere, whole in itself.
  static void put(RawSegment& memory, const ResponseHeader& header) {
    std::array<std::byte, header_bytes + 8> into{};
    const auto message = encode(header, bytes("foreign"), into);
    memory.set_word(response_length_offset, static_cast<std::uint32_t>(message.size()));
    memory.set_text(response_offset, text(message));
  }
  /// The header of the answer that is there.
  static ResponseHeader header_of(const RawSegment& memory) {
    const std::string message = memory.text(response_offset, header_bytes + 6);
    return decode_response(bytes(message)).value().header;
  }
};

TEST_F(AlteredResponse, in_its_payload_is_not_delivered) {
  expect_unknown([](RawSegment& memory) { memory.set_text(response_offset + header_bytes, "b"); });
}
TEST_F(AlteredResponse, whose_length_is_below_a_header_is_not_delivered) {
  expect_unknown([](RawSegment& memory) { memory.set_word(response_length_offset, header_bytes - 1); });
}
TEST_F(AlteredResponse, whose_length_is_beyond_its_area_is_not_delivered) {
  expect_unknown([](RawSegment& memory) { memory.set_word(response_length_offset, header_bytes + 9); });
}
TEST_F(AlteredResponse, of_another_session_is_not_delivered) {
  expect_unknown([](RawSegment& memory) {
    ResponseHeader header = header_of(memory);
    ++header.session;
    put(memory, header);
  });
}
TEST_F(AlteredResponse, to_another_request_of_the_session_is_not_delivered) {
  expect_unknown([](RawSegment& memory) {
    ResponseHeader header = header_of(memory);
    header.sequence += 0x1'0000;
    put(memory, header);
  });
}
TEST_F(AlteredResponse, whose_state_word_tells_another_request_is_not_delivered) {
  expect_unknown([](RawSegment& memory) { memory.set_word(0, memory.word(0) + 0x1'0000); });
}
TEST_F(AlteredResponse, that_is_whole_is_delivered_the_checksum_is_no_proof) {
  open();
  ASSERT_TRUE(master_->write(bytes("ask")));
  serve("answer");
  RawSegment memory(segment_.name());
  put(memory, header_of(memory));
  EXPECT_EQ(read(), "foreign");
}

TEST_F(HardenedExchange, with_a_state_word_that_nobody_has_made_ends_all_the_same) {
  open();
  for (const Phase phase : {Phase::raw, Phase::orphan}) {
    segment_.set_word({Phase::idle, 2, 0});
    ASSERT_TRUE(master_->write(bytes("ask")));
    segment_.set_word({phase, 2, 1});
    expect_no_answer(ExchangeOutcome::unknown, SharedMemoryError::damaged);
  }
  for (const Phase phase : {Phase::request, Phase::busy, Phase::response, Phase::orphan}) {
    segment_.set_word({phase, 2, 0});
    EXPECT_EQ(master_->write(bytes("ask")), tl::unexpected(SharedMemoryError::slave_is_busy));
  }
}

TEST_F(HardenedExchange, is_not_disturbed_by_rings_that_mean_nothing) {  // I11
  open();
  for (int i = 0; i < 3; ++i) ring(".response");
  ASSERT_TRUE(master_->write(bytes("ask")));
  for (int i = 0; i < 3; ++i) ring(".request");
  serve("answer");
  EXPECT_EQ(read(), "answer");
  // Of the three rings two are left.
  ASSERT_TRUE(master_->write(bytes("next")));
  serve("own");
  EXPECT_EQ(read(), "own");
  EXPECT_THAT(executed_, ElementsAre("ask", "next"));
}

TEST_F(HardenedExchange, with_one_doorbell_makes_no_second_one) {
  Options options = impatient();
  options.doorbells = Options::Doorbells::one;
  open(options);
  ASSERT_TRUE(master_->write(bytes("ask")));
  serve("answer");
  EXPECT_EQ(read(), "answer");
  EXPECT_FALSE(Doorbell::remove(segment_.name() + ".response"));
}

}  // namespace
}  // namespace protocol::hardened
