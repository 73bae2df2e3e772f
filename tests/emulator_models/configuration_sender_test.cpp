// Both ends of a transfer, with a line between them that loses, damages and delays what it is told to.
#include "emulator_models/configuration_sender.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "emulator_models/configuration_service.hpp"

namespace emulator_models {
namespace {

using protocol::fx::as_span;
using protocol::fx::FrameBytes;

/// A line to a service; what of it goes wrong is said by the number of the message, from 1 on.
class Line final : public protocol::SerialPort {
 public:
  explicit Line(ConfigurationService& service) : service_{service} {}

  std::function<void(int number, FrameBytes& message)> on_request = [](int, FrameBytes&) {};
  std::function<void(int number, FrameBytes& message)> on_answer = [](int, FrameBytes&) {};
  int messages = 0;

  tl::expected<void, protocol::PortError> open() noexcept override { return {}; }
  void close() noexcept override {}
  bool is_open() const noexcept override { return true; }
  tl::expected<std::size_t, protocol::PortError> write(std::span<const std::byte> bytes) noexcept override {
    FrameBytes message(bytes.begin(), bytes.end());
    on_request(++messages, message);
    if (message.empty()) return bytes.size();
    const auto request = decode_transfer_request(as_span(message));
    FrameBytes answer;
    if (request) {
      answer = encode(service_.answer(*request));
    } else {
      answer.push_back(protocol::fx::nak);
    }
    on_answer(messages, answer);
    received_.insert(received_.end(), answer.begin(), answer.end());
    return bytes.size();
  }
  tl::expected<std::size_t, protocol::PortError> read(std::span<std::byte> into) noexcept override {
    // In pieces, as a line brings them.
    const std::size_t count = std::min({into.size(), received_.size(), std::size_t{100}});
    std::copy_n(received_.begin(), count, into.begin());
    received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  void set_timeouts(const protocol::PortTimeouts&) noexcept override {}
  void purge() noexcept override { received_.clear(); }

 private:
  ConfigurationService& service_;
  std::deque<std::byte> received_;
};

struct ConfigurationSenderTest : testing::Test {
  std::vector<std::string> loaded;
  std::string refusal;  ///< of the PLC; empty: it takes the text
  ConfigurationService service{[this](std::string_view text) -> tl::expected<void, std::string> {
    if (!refusal.empty()) return tl::unexpected{refusal};
    loaded.emplace_back(text);
    return {};
  }};
  Line line{service};
  ConfigurationSender sender{line};
};

TEST_F(ConfigurationSenderTest, a_text_arrives_whole_whatever_its_length) {
  for (const std::size_t bytes : {std::size_t{1}, chunk_bytes_max - 1, chunk_bytes_max, chunk_bytes_max + 1,
                                  2 * chunk_bytes_max, std::size_t{1'048'576}}) {
    std::string text(bytes, '\0');
    for (std::size_t i = 0; i < bytes; ++i) text[i] = static_cast<char>(i * 7);
    const auto sent = sender.send(text);
    ASSERT_TRUE(sent) << sent.error().reason;
    EXPECT_TRUE(loaded.back() == text) << bytes;
  }
}

TEST_F(ConfigurationSenderTest, a_text_without_bytes_or_beyond_the_bound_is_refused_before_it_is_sent) {
  for (const std::size_t bytes : {0, 1'048'577}) {
    line.messages = 0;
    const auto sent = sender.send(std::string(bytes, 'a'));
    ASSERT_FALSE(sent);
    EXPECT_TRUE(sent.error().is_refusal);
    EXPECT_EQ(sent.error().reason, "a configuration has 1 to 1048576 bytes");
    EXPECT_EQ(line.messages, 1);
  }
}

TEST_F(ConfigurationSenderTest, the_reason_of_a_refusal_comes_back_whole) {
  for (const std::size_t bytes :
       {std::size_t{1}, reason_part_bytes_max - 1, reason_part_bytes_max, reason_part_bytes_max + 1,
        3 * reason_part_bytes_max, ConfigurationService::reason_bytes_max}) {
    refusal = ":2:1: " + std::string(bytes - std::min<std::size_t>(bytes, 6), 'x');
    const auto sent = sender.send("text");
    ASSERT_FALSE(sent);
    EXPECT_TRUE(sent.error().is_refusal);
    EXPECT_EQ(sent.error().reason, refusal);
  }
}

TEST_F(ConfigurationSenderTest, a_reason_beyond_the_bound_shows_where_it_was_cut) {
  refusal = ":2:1: " + std::string(ConfigurationService::reason_bytes_max - 5, 'x');
  const auto sent = sender.send("text");
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().reason, refusal.substr(0, ConfigurationService::reason_bytes_max - 6) + " [cut]");
}

TEST_F(ConfigurationSenderTest, each_message_may_be_lost_or_damaged_once_in_either_direction) {
  const std::string text(3 * chunk_bytes_max, 'a');
  constexpr int messages = 5;
  for (int broken = 1; broken <= messages; ++broken) {
    const auto lose = [&](int number, FrameBytes& message) {
      if (number == broken) message.clear();
    };
    const auto damage = [&](int number, FrameBytes& message) {
      if (number == broken) message[message.size() / 2] ^= std::byte{1};
    };
    const auto nothing = [](int, FrameBytes&) {};
    for (const auto& [on_request, on_answer] :
         std::vector<std::pair<decltype(line.on_request), decltype(line.on_answer)>>{
             {lose, nothing}, {damage, nothing}, {nothing, lose}, {nothing, damage}}) {
      line.messages = 0;
      line.on_request = on_request;
      line.on_answer = on_answer;
      loaded.clear();
      const auto sent = sender.send(text);
      ASSERT_TRUE(sent) << broken << ": " << sent.error().reason;
      EXPECT_GT(line.messages, messages) << "the fault was not met";
      ASSERT_FALSE(loaded.empty());
      EXPECT_EQ(loaded.back(), text);
    }
  }
}

TEST_F(ConfigurationSenderTest,
       a_peer_that_is_silent_or_no_configured_PLC_is_given_up_and_not_called_a_refusal) {
  line.on_request = [](int, FrameBytes& message) { message.clear(); };
  auto sent = sender.send("text");
  ASSERT_FALSE(sent);
  EXPECT_FALSE(sent.error().is_refusal);
  EXPECT_EQ(sent.error().reason, "no answer");
  EXPECT_EQ(line.messages, ConfigurationSender::tries_max);
  line.on_request = [](int, FrameBytes& message) { message.back() = std::byte{'?'}; };
  sent = sender.send("text");
  ASSERT_FALSE(sent);
  EXPECT_FALSE(sent.error().is_refusal);
  EXPECT_NE(sent.error().reason.find("no message it knows"), std::string::npos);
}

// H3 of the protocol: an answer that comes late stands in front of the next one.
TEST_F(ConfigurationSenderTest, a_late_answer_is_not_taken_for_that_of_the_next_request) {
  refusal = ":1:1: no";
  FrameBytes late;
  line.on_answer = [&](int, FrameBytes& answer) {
    const FrameBytes own = answer;
    answer = late;
    answer.insert(
        answer.end(), own.begin(),
        own.begin() + static_cast<std::ptrdiff_t>(std::min(own.size(), answer.capacity() - answer.size())));
    late = own;
  };
  const auto sent = sender.send("text");
  ASSERT_FALSE(sent) << "the chunk's answer was taken for that of the commit";
  EXPECT_EQ(sent.error().reason, refusal);
}

TEST_F(ConfigurationSenderTest, who_is_overtaken_by_another_begins_anew_and_neither_gets_a_mixture) {
  const std::string text(2 * chunk_bytes_max, 'a');
  const std::string other(2 * chunk_bytes_max, 'b');
  Line other_line{service};
  // Before the second chunk, and before the commit, another one sends all of his.
  for (const int overtaken : {3, 4}) {
    line.messages = 0;
    loaded.clear();
    line.on_request = [&](int number, FrameBytes&) {
      if (number != overtaken) return;
      EXPECT_TRUE(ConfigurationSender{other_line}.send(other));
    };
    const auto sent = sender.send(text);
    EXPECT_EQ(loaded.front(), other);
    if (sent) {
      EXPECT_EQ(loaded.back(), text);
    } else {
      EXPECT_EQ(loaded.size(), 1U);
    }
  }
}

TEST_F(ConfigurationSenderTest, another_who_has_only_begun_is_not_committed_in_its_place) {
  line.on_request = [&](int number, FrameBytes&) {
    if (number != 3) return;
    const std::string other = "other";
    EXPECT_TRUE(service
                    .answer({.command = TransferCommand::begin,
                             .number = soft_plc::crc32(other),
                             .second = 5,
                             .bytes = {}})
                    .taken);
  };
  const auto sent = sender.send("text");
  ASSERT_FALSE(sent);
  EXPECT_NE(sent.error().reason.find("another transfer has begun"), std::string::npos) << sent.error().reason;
  EXPECT_TRUE(loaded.empty());
}

TEST_F(ConfigurationSenderTest, the_reason_of_another_refusal_is_not_given) {
  refusal = ":1:1: no";
  ASSERT_FALSE(sender.send("text"));
  const auto of_other = service.answer(
      {.command = TransferCommand::reason, .number = 0, .second = soft_plc::crc32("other"), .bytes = {}});
  EXPECT_TRUE(of_other.text.empty());
  const auto own = service.answer(
      {.command = TransferCommand::reason, .number = 0, .second = soft_plc::crc32("text"), .bytes = {}});
  EXPECT_EQ(own.text.size(), refusal.size());
  const auto beyond = service.answer({.command = TransferCommand::reason,
                                      .number = 0xFFFFFFFF,
                                      .second = soft_plc::crc32("text"),
                                      .bytes = {}});
  EXPECT_TRUE(beyond.text.empty());
}

}  // namespace
}  // namespace emulator_models
