// The FX driver against a port whose every answer is written down. Frames and sums are the worked examples of
// the fact base, not what the codec makes.
#include "kernel_mocks/fx_driver.hpp"

#include <array>
#include <set>

#include <gtest/gtest.h>

#include "tests/kernel_mocks/scripted_port.hpp"

namespace kernel_mocks {
namespace {

using namespace std::chrono_literals;
using protocol::PortError;
using protocol::fx::Device;
using protocol::fx::DeviceKind;
using protocol::fx::Model;

constexpr Device d123{DeviceKind::d, 123};
constexpr Device y0{DeviceKind::y, 0};

const std::string ack = "\x06";
const std::string nak = "\x15";
const std::string read_d123_d124 =
    "\x02"
    "010F604"
    "\x03"
    "74";
const std::string reply_1234_abcd =
    "\x02"
    "3412CDAB"
    "\x03"
    "D7";

class FxDriverTest : public testing::Test {
 protected:
  FxDriverTest() { options.answer_timeout = 10s; }

  FxDriver driver() {
    static_cast<void>(port.open());
    return FxDriver{port, options};
  }

  ScriptedPort port;
  FxDriverOptions options;
  std::array<std::byte, 4> four{};
};

TEST_F(FxDriverTest, reads_the_worked_example_of_d123_and_d124) {
  port.replies = {ScriptedPort::whole(reply_1234_abcd)};
  FxDriver fx = driver();
  ASSERT_TRUE(fx.read_bytes(d123, four).has_value());
  EXPECT_EQ(port.written.front(), bytes_of(read_d123_d124));
  EXPECT_EQ(four, (std::array{std::byte{0x34}, std::byte{0x12}, std::byte{0xCD}, std::byte{0xAB}}));
}

TEST_F(FxDriverTest, puts_an_answer_together_that_comes_byte_by_byte) {
  port.replies = {ScriptedPort::bytewise(reply_1234_abcd)};
  FxDriver fx = driver();
  ASSERT_TRUE(fx.read_bytes(d123, four).has_value());
  EXPECT_EQ(four[3], std::byte{0xAB});
}

TEST_F(FxDriverTest, writes_the_worked_example_of_d123_and_d124) {
  port.replies = {ScriptedPort::whole(ack)};
  FxDriver fx = driver();
  ASSERT_TRUE(fx.write_words(d123, std::array<std::uint16_t, 2>{0x1234, 0xABCD}).has_value());
  EXPECT_EQ(port.written.front(), bytes_of("\x02"
                                           "110F6043412CDAB"
                                           "\x03"
                                           "49"));
}

TEST_F(FxDriverTest, forces_the_worked_examples_of_y0) {
  port.replies = {ScriptedPort::whole(ack), ScriptedPort::whole(ack)};
  FxDriver fx = driver();
  ASSERT_TRUE(fx.force(y0, true).has_value());
  ASSERT_TRUE(fx.force(y0, false).has_value());
  EXPECT_EQ(port.written[0], bytes_of("\x02"
                                      "70005"
                                      "\x03"
                                      "FF"));
  EXPECT_EQ(port.written[1], bytes_of("\x02"
                                      "80005"
                                      "\x03"
                                      "00"));
}

TEST_F(FxDriverTest, reads_a_word_low_byte_first) {
  port.replies = {
      ScriptedPort::whole("\x02"
                          "6266"
                          "\x03"
                          "D7")};
  FxDriver fx = driver();
  EXPECT_EQ(fx.read_word({DeviceKind::d, 8001}).value(), 26210);
  EXPECT_EQ(port.written.front(), bytes_of("\x02"
                                           "00E0202"
                                           "\x03"
                                           "6C"));
}

TEST_F(FxDriverTest, uses_a_wide_command_only_where_no_legacy_command_reaches) {
  // M2000 is beyond the legacy map: 8800H + 2000/8 = 88FAH, forced as 4000H + 2000 = 47D0H.
  port.replies = {ScriptedPort::whole("\x02"
                                      "01"
                                      "\x03"
                                      "64"),
                  ScriptedPort::whole(ack)};
  FxDriver fx = driver();
  std::array<std::byte, 1> one{};
  ASSERT_TRUE(fx.read_bytes({DeviceKind::m, 2000}, one).has_value());
  ASSERT_TRUE(fx.force({DeviceKind::m, 2000}, true).has_value());
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(port.written[0].data()) + 1, 9), "E0088FA01");
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(port.written[1].data()) + 1, 6), "E7D047");
}

TEST_F(FxDriverTest, connects_with_one_enq) {
  port.replies = {ScriptedPort::whole(ack)};
  FxDriver fx{port, options};
  ASSERT_TRUE(fx.connect().has_value());
  EXPECT_TRUE(port.is_open());
  EXPECT_EQ(port.written, (std::vector<Bytes>{bytes_of("\x05")}));
  EXPECT_EQ(port.timeouts.read, options.answer_timeout);
}

TEST_F(FxDriverTest, connects_at_the_third_enq) {
  port.replies = {ScriptedPort::silence(), ScriptedPort::silence(), ScriptedPort::whole(ack)};
  FxDriver fx{port, options};
  ASSERT_TRUE(fx.connect().has_value());
  EXPECT_EQ(port.written.size(), 3U);
  EXPECT_EQ(fx.counters().retries, 2U);
  EXPECT_EQ(fx.counters().time_outs, 2U);
}

TEST_F(FxDriverTest, gives_up_after_three_unanswered_enqs) {
  FxDriver fx{port, options};
  EXPECT_EQ(fx.connect().error(), FxDriverError::no_answer);
  EXPECT_EQ(port.written.size(), 3U);
}

TEST_F(FxDriverTest, does_not_ask_when_the_port_cannot_be_opened) {
  port.open_error = protocol::PortError::cannot_open;
  FxDriver fx{port, options};
  EXPECT_EQ(fx.connect().error(), FxDriverError::port_failed);
  EXPECT_EQ(fx.last_port_error(), protocol::PortError::cannot_open);
  EXPECT_TRUE(port.written.empty());
}

TEST_F(FxDriverTest, asks_again_after_silence) {
  port.replies = {ScriptedPort::silence(), ScriptedPort::whole(reply_1234_abcd)};
  FxDriver fx = driver();
  ASSERT_TRUE(fx.read_bytes(d123, four).has_value());
  EXPECT_EQ(port.written, (std::vector<Bytes>{bytes_of(read_d123_d124), bytes_of(read_d123_d124)}));
  EXPECT_EQ(fx.counters().requests, 1U);
  EXPECT_EQ(fx.counters().retries, 1U);
  EXPECT_EQ(fx.counters().time_outs, 1U);
}

TEST_F(FxDriverTest, gives_up_after_as_many_retries_as_it_was_told) {
  options.retries = 4;
  FxDriver fx = driver();
  EXPECT_EQ(fx.read_bytes(d123, four).error(), FxDriverError::no_answer);
  EXPECT_EQ(port.written.size(), 5U);
  EXPECT_EQ(fx.counters().retries, 4U);
}

TEST_F(FxDriverTest, with_no_retries_one_failure_is_enough) {
  options.retries = 0;
  port.replies = {ScriptedPort::whole(nak)};
  FxDriver fx = driver();
  EXPECT_EQ(fx.force(y0, true).error(), FxDriverError::nak);
  EXPECT_EQ(port.written.size(), 1U);
}

/// One bad answer, no retry.
struct Fault {
  std::string name;
  ScriptedPort::Reply reply;
  FxDriverError expected;
};

class FxDriverFaultTest : public testing::TestWithParam<Fault> {};

TEST_P(FxDriverFaultTest, is_told_apart_and_healed_by_a_retry) {
  std::array<std::byte, 4> four{};
  {
    ScriptedPort port;
    ASSERT_TRUE(port.open().has_value());
    port.replies = {GetParam().reply};
    FxDriver fx{port, {.answer_timeout = 10s, .retries = 0}};
    EXPECT_EQ(fx.read_bytes(d123, four).error(), GetParam().expected);
  }
  {
    ScriptedPort port;
    ASSERT_TRUE(port.open().has_value());
    port.replies = {GetParam().reply, ScriptedPort::whole(reply_1234_abcd)};
    FxDriver fx{port, {.answer_timeout = 10s, .retries = 1}};
    EXPECT_TRUE(fx.read_bytes(d123, four).has_value());
    EXPECT_EQ(four[0], std::byte{0x34});
  }
}

INSTANTIATE_TEST_SUITE_P(
    Answer, FxDriverFaultTest,
    testing::Values(Fault{"missing", ScriptedPort::silence(), FxDriverError::no_answer},
                    Fault{"refused", ScriptedPort::whole(nak), FxDriverError::nak},
                    Fault{"with_a_wrong_sum",
                          ScriptedPort::whole("\x02"
                                              "3412CDAB"
                                              "\x03"
                                              "D6"),
                          FxDriverError::bad_checksum},
                    Fault{"with_a_changed_digit",
                          ScriptedPort::whole("\x02"
                                              "3413CDAB"
                                              "\x03"
                                              "D7"),
                          FxDriverError::bad_checksum},
                    Fault{"cut_off",
                          ScriptedPort::whole("\x02"
                                              "3412C"),
                          FxDriverError::truncated_answer},
                    Fault{"cut_off_before_its_sum",
                          ScriptedPort::bytewise("\x02"
                                                 "3412CDAB"
                                                 "\x03"
                                                 "D"),
                          FxDriverError::truncated_answer},
                    Fault{"doubled", ScriptedPort::whole(reply_1234_abcd + reply_1234_abcd),
                          FxDriverError::surplus_bytes},
                    Fault{"too_short",
                          ScriptedPort::whole("\x02"
                                              "6266"
                                              "\x03"
                                              "D7"),
                          FxDriverError::wrong_length},
                    Fault{"too_long",
                          ScriptedPort::whole("\x02"
                                              "3412CDAB00"
                                              "\x03"
                                              "37"),
                          FxDriverError::wrong_length},
                    Fault{"of_another_kind", ScriptedPort::whole(ack), FxDriverError::unexpected_answer},
                    Fault{"an_enq", ScriptedPort::whole("\x05"), FxDriverError::unexpected_answer},
                    Fault{"with_lower_case_digits",
                          ScriptedPort::whole("\x02"
                                              "3412cdab"
                                              "\x03"
                                              "57"),
                          FxDriverError::bad_frame},
                    Fault{"longer_than_any_frame", ScriptedPort::whole("\x02" + std::string(600, '0')),
                          FxDriverError::bad_frame}),
    [](const testing::TestParamInfo<Fault>& fault) { return fault.param.name; });

TEST_F(FxDriverTest, data_in_answer_to_a_write_are_of_another_kind) {
  options.retries = 0;
  port.replies = {ScriptedPort::whole(reply_1234_abcd)};
  FxDriver fx = driver();
  EXPECT_EQ(fx.force(y0, true).error(), FxDriverError::unexpected_answer);
}

TEST_F(FxDriverTest, skips_noise_in_front_of_an_answer) {
  port.replies = {ScriptedPort::whole("\x7F?" + reply_1234_abcd)};
  FxDriver fx = driver();
  EXPECT_TRUE(fx.read_bytes(d123, four).has_value());
}

TEST_F(FxDriverTest, noise_without_an_answer_is_a_time_out_in_the_end) {
  options = {.answer_timeout = 1ms, .retries = 0};
  port.endless_noise = std::byte{'?'};
  FxDriver fx = driver();
  EXPECT_EQ(fx.read_bytes(d123, four).error(), FxDriverError::no_answer);
  EXPECT_EQ(fx.counters().time_outs, 1U);
}

TEST_F(FxDriverTest, purges_before_a_retry_so_that_a_late_answer_is_not_taken_for_the_next) {
  const std::string late_0000 =
      "\x02"
      "00000000"
      "\x03"
      "83";
  port.replies = {ScriptedPort::after_time_out(late_0000), ScriptedPort::whole(reply_1234_abcd)};
  FxDriver fx = driver();
  ASSERT_TRUE(fx.read_bytes(d123, four).has_value());
  EXPECT_EQ(four[0], std::byte{0x34});
  EXPECT_EQ(port.purges, 1U);
}

TEST_F(FxDriverTest, purges_before_the_request_after_one_that_failed_for_good) {
  options.retries = 0;
  port.replies = {ScriptedPort::after_time_out(ack), ScriptedPort::whole(nak)};
  FxDriver fx = driver();
  EXPECT_EQ(fx.force(y0, true).error(), FxDriverError::no_answer);
  EXPECT_EQ(fx.force(y0, false).error(), FxDriverError::nak);
}

TEST_F(FxDriverTest, does_not_purge_while_all_goes_well) {
  port.replies = {ScriptedPort::whole(ack), ScriptedPort::whole(ack)};
  FxDriver fx = driver();
  ASSERT_TRUE(fx.force(y0, true).has_value());
  ASSERT_TRUE(fx.force(y0, false).has_value());
  EXPECT_EQ(port.purges, 0U);
}

TEST_F(FxDriverTest, a_failed_port_is_reported_and_not_asked_again) {
  port.write_error = protocol::PortError::refused;
  FxDriver fx = driver();
  EXPECT_EQ(fx.force(y0, true).error(), FxDriverError::port_failed);
  EXPECT_EQ(fx.last_port_error(), protocol::PortError::refused);
  port.write_error.reset();
  port.read_error = protocol::PortError::line_lost;
  EXPECT_EQ(fx.force(y0, true).error(), FxDriverError::port_failed);
  EXPECT_EQ(fx.last_port_error(), protocol::PortError::line_lost);
  EXPECT_EQ(fx.counters().retries, 0U);
}

// --- a port that tells what became of a request ---

constexpr std::array in_doubt{PortError::unanswered, PortError::receiver_gone, PortError::damaged};

TEST_F(FxDriverTest, does_not_repeat_a_write_or_a_force_that_may_have_been_executed) {
  for (const PortError reason : in_doubt) {
    port = {};
    port.replies = {ScriptedPort::failure(reason), ScriptedPort::whole(ack), ScriptedPort::failure(reason)};
    FxDriver fx = driver();
    EXPECT_EQ(fx.force(y0, true).error(), FxDriverError::outcome_unknown);
    EXPECT_EQ(port.written.size(), 1U);
    EXPECT_EQ(fx.last_port_error(), reason);
    EXPECT_TRUE(fx.force(y0, false).has_value()) << "another request is the caller's decision";
    EXPECT_EQ(fx.write_words(d123, std::array<std::uint16_t, 1>{1}).error(), FxDriverError::outcome_unknown);
    EXPECT_EQ(port.written.size(), 3U);
    EXPECT_EQ(fx.counters().retries, 0U);
  }
}

TEST_F(FxDriverTest, keeps_the_first_request_in_doubt_and_tells_which_and_why) {
  port.replies = {ScriptedPort::failure(PortError::receiver_gone),
                  ScriptedPort::failure(PortError::unanswered)};
  FxDriver fx = driver();
  EXPECT_FALSE(fx.request_in_doubt());
  ASSERT_FALSE(fx.write_words(d123, std::array<std::uint16_t, 2>{1, 2}).has_value());
  ASSERT_FALSE(fx.force(y0, true).has_value());
  ASSERT_TRUE(fx.request_in_doubt());
  EXPECT_EQ(
      to_string(*fx.request_in_doubt()),
      "write 4 bytes from D123 on: the one that had taken the message ended, or was started anew, before it "
      "answered");
}

TEST(FxDriverRequestInDoubt, is_told_by_what_it_does_to_which_device) {
  using protocol::fx::Command;
  constexpr Device m96{DeviceKind::m, 96};
  const auto begin_of = [&](Command command) {
    const std::string text = to_string(RequestInDoubt{command, m96, 1, protocol::PortError::unanswered});
    return text.substr(0, text.find(':'));
  };
  EXPECT_EQ(begin_of(Command::write), "write 1 byte from M96 on");
  EXPECT_EQ(begin_of(Command::write_wide), "write 1 byte from M96 on");
  EXPECT_EQ(begin_of(Command::force_on), "force M96 on");
  EXPECT_EQ(begin_of(Command::force_on_wide), "force M96 on");
  EXPECT_EQ(begin_of(Command::force_off), "force M96 off");
  EXPECT_EQ(begin_of(Command::force_off_wide), "force M96 off");
}

TEST_F(FxDriverTest, repeats_a_read_and_enq_whatever_became_of_them) {
  for (const PortError reason : in_doubt) {
    port = {};
    port.replies = {ScriptedPort::failure(reason), ScriptedPort::whole(ack), ScriptedPort::failure(reason),
                    ScriptedPort::whole(reply_1234_abcd)};
    FxDriver fx = driver();
    EXPECT_TRUE(fx.connect().has_value());
    EXPECT_TRUE(fx.read_bytes(d123, four).has_value());
    EXPECT_EQ(port.written.size(), 4U);
    EXPECT_FALSE(fx.request_in_doubt());
  }
}

TEST_F(FxDriverTest, of_a_read_that_is_never_answered_says_just_that) {
  options.retries = 1;
  port.replies = {ScriptedPort::failure(PortError::unanswered), ScriptedPort::failure(PortError::unanswered)};
  FxDriver fx = driver();
  EXPECT_EQ(fx.read_bytes(d123, four).error(), FxDriverError::no_answer);
  EXPECT_FALSE(fx.request_in_doubt());
}

TEST_F(FxDriverTest, repeats_what_was_not_executed_and_gives_up_in_the_end) {
  options.send_timeout = 0s;
  port.replies = {ScriptedPort::failure(PortError::not_executed), ScriptedPort::whole(ack)};
  FxDriver fx = driver();
  EXPECT_TRUE(fx.force(y0, true).has_value());
  EXPECT_EQ(port.written.size(), 2U);
  port.write_error = PortError::not_executed;
  EXPECT_EQ(fx.force(y0, false).error(), FxDriverError::not_executed);
  EXPECT_EQ(fx.counters().retries, 1 + options.retries);
  EXPECT_EQ(fx.connect().error(), FxDriverError::not_executed);
}

TEST_F(FxDriverTest, gives_who_is_being_started_the_time_to_take_a_request) {
  options.send_timeout = 20ms;
  options.retries = 1;
  port.write_error = PortError::not_executed;
  FxDriver fx = driver();
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(fx.force(y0, true).has_value());
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 20ms);
}

TEST_F(FxDriverTest, tells_the_port_both_time_outs) {
  port.replies = {ScriptedPort::whole(ack)};
  options.send_timeout = 3s;
  FxDriver fx = driver();
  ASSERT_TRUE(fx.connect().has_value());
  EXPECT_EQ(port.timeouts.write, 3s);
  EXPECT_EQ(port.timeouts.read, 10s);
}

TEST_F(FxDriverTest, a_request_that_the_carrier_takes_only_in_part_has_timed_out) {
  options.retries = 0;
  port.write_bytes_max = 3;
  FxDriver fx = driver();
  EXPECT_EQ(fx.force(y0, true).error(), FxDriverError::write_timed_out);
}

TEST_F(FxDriverTest, asks_for_64_bytes_and_not_for_65_nor_for_none) {
  port.replies = {ScriptedPort::silence()};
  options.retries = 0;
  FxDriver fx = driver();
  std::array<std::byte, 65> bytes{};
  EXPECT_EQ(fx.read_bytes({DeviceKind::d, 0}, std::span{bytes}.first(64)).error(), FxDriverError::no_answer);
  EXPECT_EQ(port.written.front(), bytes_of("\x02"
                                           "0100040"
                                           "\x03"
                                           "58"));
  EXPECT_EQ(fx.read_bytes({DeviceKind::d, 0}, bytes).error(), FxDriverError::bad_length);
  EXPECT_EQ(fx.read_bytes({DeviceKind::d, 0}, {}).error(), FxDriverError::bad_length);
  EXPECT_EQ(fx.write_bytes({DeviceKind::d, 0}, bytes).error(), FxDriverError::bad_length);
  EXPECT_EQ(port.written.size(), 1U);
}

TEST_F(FxDriverTest, refuses_devices_that_the_model_does_not_have) {
  options.model = Model::fx1s;
  FxDriver fx = driver();
  EXPECT_EQ(fx.force({DeviceKind::m, 2000}, true).error(), FxDriverError::not_reachable);
  EXPECT_EQ(fx.force(d123, true).error(), FxDriverError::not_reachable);
  EXPECT_TRUE(port.written.empty());
}

TEST(FxDriverErrors, have_a_text_each) {
  std::set<std::string_view> texts;
  for (std::size_t number = 0; number < fx_driver_error_count; ++number) {
    texts.insert(to_string(static_cast<FxDriverError>(number)));
  }
  EXPECT_EQ(texts.size(), fx_driver_error_count);
  EXPECT_FALSE(texts.contains("unknown error"));
}

}  // namespace
}  // namespace kernel_mocks
