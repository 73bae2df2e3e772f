// The codec of FX frames against the worked examples, and one defect at a time.
#include "protocol/fx/frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/protocol/fx/worked_examples.hpp"

namespace protocol::fx {
namespace {

using examples::bytes;

template <class Bytes>
std::vector<std::byte> vector_of(const Bytes& source) {
  return {source.begin(), source.end()};
}

/// A frame with any payload and the right sum, made here and not by the codec.
std::vector<std::byte> framed(std::string_view payload) {
  std::vector<std::byte> frame{std::byte{0x02}};
  unsigned sum = 0x03;
  for (const char c : payload) {
    frame.push_back(static_cast<std::byte>(c));
    sum += static_cast<unsigned char>(c);
  }
  frame.push_back(std::byte{0x03});
  for (const unsigned nibble : {sum / 16 % 16, sum % 16})
    frame.push_back(static_cast<std::byte>("0123456789ABCDEF"[nibble]));
  return frame;
}

FrameError defect_of(std::string_view payload) {
  const auto request = decode_request(framed(payload));
  EXPECT_FALSE(request.has_value()) << payload;
  return request ? FrameError{} : request.error();
}

TEST(FxFrame, decodes_every_worked_request) {
  for (const auto& example : examples::requests()) {
    SCOPED_TRACE(example.what);
    const auto request = decode_request(bytes(example.frame_hex));
    ASSERT_TRUE(request.has_value()) << to_string(request.error());
    EXPECT_EQ(request->command, example.command);
    EXPECT_EQ(request->address, example.address);
    EXPECT_EQ(request->count_bytes, example.count_bytes);
    EXPECT_EQ(vector_of(request->data), bytes(example.data_hex));
  }
}

TEST(FxFrame, encodes_every_worked_request) {
  for (const auto& example : examples::requests()) {
    SCOPED_TRACE(example.what);
    Request request{example.command, example.address, example.count_bytes, {}};
    for (const std::byte byte : bytes(example.data_hex)) request.data.push_back(byte);
    EXPECT_EQ(vector_of(encode(request)), bytes(example.frame_hex));
  }
}

TEST(FxFrame, decodes_every_worked_reply) {
  for (const auto& example : examples::replies()) {
    SCOPED_TRACE(example.what);
    const auto data = decode_data_reply(bytes(example.frame_hex));
    ASSERT_TRUE(data.has_value()) << to_string(data.error());
    EXPECT_EQ(vector_of(*data), bytes(example.data_hex));
  }
}

TEST(FxFrame, encodes_every_worked_reply) {
  for (const auto& example : examples::replies())
    EXPECT_EQ(vector_of(encode_data_reply(bytes(example.data_hex))), bytes(example.frame_hex))
        << example.what;
}

TEST(FxFrame, force_addresses_travel_low_byte_first_and_others_high_byte_first) {
  EXPECT_EQ(vector_of(encode({Command::force_on, 0x1234, 0, {}})), framed("73412"));
  EXPECT_EQ(vector_of(encode({Command::read, 0x1234, 1, {}})), framed("0123401"));
}

TEST(FxFrame, a_sum_that_a_published_overview_prints_wrong_is_refused) {
  const auto reply = decode_data_reply(bytes("02 33 35 38 34 03 44 36"));
  ASSERT_FALSE(reply.has_value());
  EXPECT_EQ(reply.error(), FrameError::bad_checksum);
}

TEST(FxFrame, one_right_character_of_the_sum_is_not_enough) {
  for (const auto* frame : {"02 30 39 03 36 44", "02 30 39 03 37 43"}) {
    const auto reply = decode_data_reply(bytes(frame));
    ASSERT_FALSE(reply.has_value());
    EXPECT_EQ(reply.error(), FrameError::bad_checksum);
  }
}

TEST(FxFrame, a_sum_in_lower_case_is_refused) {
  const auto reply = decode_data_reply(bytes("02 30 39 03 36 63"));
  ASSERT_FALSE(reply.has_value());
  EXPECT_EQ(reply.error(), FrameError::bad_checksum);
}

TEST(FxFrame, each_single_wrong_byte_of_a_worked_request_is_noticed) {
  for (const auto& example : examples::requests()) {
    const auto good = bytes(example.frame_hex);
    for (std::size_t i = 0; i < good.size(); ++i) {
      auto bad = good;
      bad[i] ^= std::byte{0x01};
      EXPECT_FALSE(decode_request(bad).has_value()) << example.what << ", byte " << i;
    }
  }
}

TEST(FxFrame, without_its_envelope_it_is_no_frame) {
  for (const auto* not_a_frame : {"", "05", "02", "02 03 30", "30 30 03 36 33", "02 30 30 30 30"}) {
    const auto request = decode_request(bytes(not_a_frame));
    ASSERT_FALSE(request.has_value());
    EXPECT_EQ(request.error(), FrameError::no_frame) << not_a_frame;
  }
}

TEST(FxFrame, a_frame_one_byte_beyond_the_longest_is_too_long) {
  const auto longest = framed("E100000FE" + std::string(2 * data_bytes_max_wide, 'A'));
  ASSERT_EQ(longest.size(), frame_bytes_max);
  EXPECT_TRUE(decode_request(longest).has_value());
  EXPECT_EQ(defect_of("E100000FE" + std::string(2 * data_bytes_max_wide + 1, 'A')), FrameError::too_long);
}

TEST(FxFrame, commands_of_the_programming_tools_that_are_left_out_are_unknown) {
  for (const auto* payload :
       {"", "B", "A1", "E01805C2E", "E11805C02FFFF", "4", "E41", "ED1", "2", "E", "E0", "e00400002"})
    EXPECT_EQ(defect_of(payload), FrameError::unknown_command) << payload;
}

TEST(FxFrame, a_length_that_does_not_fit_the_command_is_refused) {
  for (const auto* payload :
       {"000A00", "000A0020", "700", "700050", "E004000020", "E0040000", "E7004", "1100", "1100002ABC"})
    EXPECT_EQ(defect_of(payload), FrameError::bad_length) << payload;
}

TEST(FxFrame, lower_case_and_other_characters_are_not_digits) {
  for (const auto* payload : {"000a002", "00 A002", "000G002", "7000x", "11000023C0g", "0-00002"})
    EXPECT_EQ(defect_of(payload), FrameError::bad_digit) << payload;
}

TEST(FxFrame, a_count_of_zero_or_one_that_does_not_match_the_data_is_refused) {
  for (const auto* payload : {"0100000", "1100000", "1100002AA", "1100001AABB", "E00400000"})
    EXPECT_EQ(defect_of(payload), FrameError::bad_count) << payload;
}

TEST(FxFrame, each_command_has_a_greatest_count) {
  EXPECT_TRUE(decode_request(framed("0100040")).has_value());
  EXPECT_EQ(defect_of("0100041"), FrameError::bad_count);
  EXPECT_TRUE(decode_request(framed("1100040" + std::string(128, '0'))).has_value());
  EXPECT_EQ(defect_of("1100041" + std::string(130, '0')), FrameError::bad_count);
  EXPECT_TRUE(decode_request(framed("E004000FE")).has_value());
  EXPECT_EQ(defect_of("E004000FF"), FrameError::bad_count);
}

TEST(FxFrame, defects_are_reported_in_the_order_in_which_a_frame_is_checked) {
  auto frame = framed("0zz");  // wrong length and wrong digits: the length comes first
  EXPECT_EQ(decode_request(frame).error(), FrameError::bad_length);
  frame.back() = std::byte{'?'};  // now a wrong sum, too: the sum comes before both
  EXPECT_EQ(decode_request(frame).error(), FrameError::bad_checksum);
}

TEST(FxFrame, a_reply_holds_an_even_number_of_digits_and_at_least_one_byte) {
  EXPECT_EQ(decode_data_reply(framed("123")).error(), FrameError::bad_length);
  EXPECT_EQ(decode_data_reply(framed("1x")).error(), FrameError::bad_digit);
  EXPECT_EQ(decode_data_reply(framed("")).error(), FrameError::bad_count);
  EXPECT_EQ(decode_data_reply(framed(std::string(2 * data_bytes_max_wide + 2, '0'))).error(),
            FrameError::bad_count);
  EXPECT_EQ(decode_data_reply(framed(std::string(2 * data_bytes_max_wide, '0')))->size(),
            data_bytes_max_wide);
}

TEST(FxFrame, every_defect_has_a_name_of_its_own) {
  std::vector<std::string_view> names;
  for (int error = 0; error <= static_cast<int>(FrameError::bad_count); ++error)
    names.push_back(to_string(static_cast<FrameError>(error)));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace protocol::fx
