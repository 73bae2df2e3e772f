// The messages of a transfer: what they look like on the line, what is refused, that no FX PLC takes one for its own.
#include "emulator_models/configuration_frames.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <string_view>

namespace emulator_models {
namespace {

using protocol::fx::as_span;
using protocol::fx::DataBytes;
using protocol::fx::FrameBytes;

std::string text_of(const FrameBytes& frame) {
  std::string text;
  for (const std::byte byte : frame) text += static_cast<char>(byte);
  return text;
}

DataBytes bytes_of(std::size_t count, std::byte value = std::byte{'a'}) { return DataBytes(count, value); }

std::optional<TransferRequest> request_of(const DataBytes& payload) {
  return decode_transfer_request(as_span(protocol::fx::encode_data_reply(as_span(payload))));
}
std::optional<TransferAnswer> answer_of(const DataBytes& payload) {
  return decode_transfer_answer(as_span(protocol::fx::encode_data_reply(as_span(payload))));
}

TransferRequest chunk(std::size_t count) {
  return {.command = TransferCommand::chunk, .number = 7, .second = 0, .bytes = bytes_of(count)};
}

// Frames as the header draws them; sums added up by hand.
TEST(ConfigurationFrames, look_on_the_line_as_the_header_says) {
  EXPECT_EQ(text_of(encode(TransferRequest{
                .command = TransferCommand::begin, .number = 0xCBF43926, .second = 9, .bytes = {}})),
            "\x02"
            "C0CBF4392600000009"
            "\x03"
            "D2");
  EXPECT_EQ(text_of(encode(chunk(2))),
            "\x02"
            "C1000000076161"
            "\x03"
            "CC");
  EXPECT_EQ(text_of(encode(TransferAnswer{
                .taken = false, .command = TransferCommand::commit, .number = 1, .text = bytes_of(1)})),
            "\x02"
            "D1C20000000161"
            "\x03"
            "D5");
}

TEST(ConfigurationFrames, what_was_encoded_decodes_to_itself_at_each_bound) {
  for (const TransferRequest& request :
       {TransferRequest{.command = TransferCommand::begin, .number = 0xFFFFFFFF, .second = 1, .bytes = {}},
        chunk(1), chunk(chunk_bytes_max),
        TransferRequest{.command = TransferCommand::commit, .number = 0, .second = 0, .bytes = {}},
        TransferRequest{
            .command = TransferCommand::reason, .number = 248, .second = 0x80000000, .bytes = {}}}) {
    const FrameBytes frame = encode(request);
    EXPECT_LE(frame.size(), protocol::fx::frame_bytes_max);
    EXPECT_EQ(decode_transfer_request(as_span(frame)), request);
    EXPECT_EQ(decode_transfer_answer(as_span(frame)), std::nullopt);
  }
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, reason_part_bytes_max}) {
    const TransferAnswer answer{
        .taken = false, .command = TransferCommand::commit, .number = 3, .text = bytes_of(count)};
    EXPECT_EQ(decode_transfer_answer(as_span(encode(answer))), answer);
  }
}

TEST(ConfigurationFrames, bytes_beyond_the_bound_are_left_out) {
  EXPECT_EQ(decode_transfer_request(as_span(encode(chunk(chunk_bytes_max + 1)))), chunk(chunk_bytes_max));
  TransferAnswer answer{.taken = false,
                        .command = TransferCommand::begin,
                        .number = 3,
                        .text = bytes_of(reason_part_bytes_max + 1)};
  const auto decoded = decode_transfer_answer(as_span(encode(answer)));
  answer.text.pop_back();
  EXPECT_EQ(decoded, answer);
}

TEST(ConfigurationFrames, one_byte_less_or_more_than_a_message_has_is_no_message) {
  const auto of = [](std::uint8_t first, std::size_t count) {
    DataBytes payload = bytes_of(count, std::byte{0xC0});
    payload[0] = std::byte{first};
    return payload;
  };
  for (std::size_t count = 1; count <= 12; ++count) {
    EXPECT_EQ(request_of(of(0xC0, count)).has_value(), count == 9) << count;
    EXPECT_EQ(request_of(of(0xC1, count)).has_value(), count >= 6) << count;
    EXPECT_EQ(request_of(of(0xC2, count)).has_value(), count == 5) << count;
    EXPECT_EQ(request_of(of(0xC3, count)).has_value(), count == 9) << count;
    EXPECT_FALSE(request_of(of(0xBF, count))) << count;
    EXPECT_FALSE(request_of(of(0xC4, count))) << count;
    EXPECT_EQ(answer_of(of(0xD0, count)).has_value(), count == 6) << count;
    EXPECT_EQ(answer_of(of(0xD1, count)).has_value(), count >= 6) << count;
    EXPECT_FALSE(answer_of(of(0xCF, count))) << count;
    EXPECT_FALSE(answer_of(of(0xD2, count))) << count;
  }
}

TEST(ConfigurationFrames, a_frame_that_is_cut_off_or_has_a_wrong_byte_is_no_message) {
  const FrameBytes whole = encode(chunk(chunk_bytes_max));
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes)
    EXPECT_FALSE(decode_transfer_request(as_span(whole).first(bytes))) << bytes;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    FrameBytes damaged = whole;
    damaged[i] ^= std::byte{1};
    EXPECT_FALSE(decode_transfer_request(as_span(damaged))) << i;
  }
}

TEST(ConfigurationFrames, an_FX_PLC_takes_none_of_them_for_its_own) {
  for (const TransferRequest& request :
       {TransferRequest{.command = TransferCommand::begin, .number = 0, .second = 0, .bytes = {}}, chunk(1),
        chunk(chunk_bytes_max),
        TransferRequest{.command = TransferCommand::commit, .number = 0, .second = 0, .bytes = {}},
        TransferRequest{.command = TransferCommand::reason, .number = 0, .second = 0, .bytes = {}}})
    EXPECT_EQ(protocol::fx::decode_request(as_span(encode(request))),
              tl::unexpected(protocol::fx::FrameError::unknown_command));
}

TEST(ConfigurationFrames, FX_requests_and_noise_are_no_message) {
  std::mt19937 random{1};
  for (int i = 0; i < 20'000; ++i) {
    FrameBytes noise(random() % 522);
    for (std::byte& byte : noise) byte = static_cast<std::byte>(random());
    if (noise.size() > 3 && i % 2 == 0) {
      noise.front() = protocol::fx::stx;
      noise[noise.size() - 3] = protocol::fx::etx;
    }
    EXPECT_FALSE(decode_transfer_request(as_span(noise)));
    EXPECT_FALSE(decode_transfer_answer(as_span(noise)));
  }
  const protocol::fx::Request request{.command = protocol::fx::Command::write_wide,
                                      .address = 0xC0C0,
                                      .count_bytes = 9,
                                      .data = bytes_of(9, std::byte{0xC0})};
  EXPECT_FALSE(decode_transfer_request(as_span(protocol::fx::encode(request))));
}

}  // namespace
}  // namespace emulator_models
