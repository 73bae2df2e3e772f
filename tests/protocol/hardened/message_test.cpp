// Headers of requests and responses. The worked examples were computed by a few lines of another language from the
// layout in message.hpp.

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "protocol/hardened/crc32c.hpp"
#include "protocol/hardened/message.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol::hardened {
namespace {

using Bytes = std::vector<std::byte>;

Bytes from_hex(const std::string& text) {
  Bytes result;
  for (std::size_t i = 0; i + 1 < text.size(); i += 3)
    result.push_back(static_cast<std::byte>(std::stoi(text.substr(i, 2), nullptr, 16)));
  return result;
}

const Bytes example_request = from_hex(
    "4c 52 51 01 00 00 00 00 08 07 06 05 04 03 02 01 18 17 16 15 14 13 12 11 "
    "28 27 26 25 24 23 22 21 03 00 00 00 2e 0c d6 c7 61 73 6b");
const Bytes example_response = from_hex(
    "4c 52 53 01 00 00 00 00 08 07 06 05 04 03 02 01 18 17 16 15 14 13 12 11 "
    "28 27 26 25 24 23 22 21 06 00 00 00 71 f9 2d 6d 61 6e 73 77 65 72");
const Bytes example_refusal = from_hex(
    "4c 52 53 01 02 00 00 00 07 00 00 00 00 00 00 00 08 00 00 00 00 00 00 00 "
    "09 00 00 00 00 00 00 00 00 00 00 00 4e bd 5e c8");

constexpr RequestHeader request_header{
    .session = 0x0102030405060708, .sequence = 0x1112131415161718, .expected_slave = 0x2122232425262728};
constexpr ResponseHeader response_header{.status = Status::ok,
                                         .session = 0x0102030405060708,
                                         .sequence = 0x1112131415161718,
                                         .slave = 0x2122232425262728};

template <typename Header>
Bytes encoded(const Header& header, std::string_view payload) {
  Bytes into(header_bytes + payload.size());
  const auto message = encode(header, bytes(payload), into);
  return {message.begin(), message.end()};
}

MessageError error_of_request(const Bytes& message) { return decode_request(message).error(); }

/// With a checksum that is right again.
Bytes resealed(Bytes message) {
  for (std::size_t i = 36; i < 40; ++i) message[i] = std::byte{0};
  const std::uint32_t sum = crc32c({message});
  for (unsigned i = 0; i < 4; ++i) message[36 + i] = static_cast<std::byte>(sum >> 8 * i);
  return message;
}

Bytes altered(Bytes message, std::size_t offset, unsigned value) {
  message[offset] = static_cast<std::byte>(value);
  return message;
}

TEST(Crc32c, has_the_check_value_of_the_literature) {  // RFC 3720; "123456789"
  const Bytes message = bytes("123456789");
  EXPECT_EQ(crc32c({message}), 0xE3069283U);
  EXPECT_EQ(crc32c_by_library({message}), 0xE3069283U);
}

TEST(Crc32c, is_the_same_by_instruction_and_by_library_whatever_the_length_and_the_pieces) {
  if (!has_crc32c_instruction()) GTEST_SKIP() << "this processor has no such instruction";
  Bytes all(64);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::byte>(37 * i + 11);
  for (std::size_t length = 0; length <= all.size(); ++length) {
    const auto message = std::span<const std::byte>(all).first(length);
    const std::uint32_t by_library = crc32c_by_library({message});
    for (std::size_t first = 0; first <= length; ++first) {
      const auto pieces = {message.first(first), message.subspan(first)};
      ASSERT_EQ(crc32c_by_instruction(pieces), by_library)
          << length << " bytes, " << first << " of them first";
      ASSERT_EQ(crc32c_by_library(pieces), by_library) << length << " bytes, " << first << " of them first";
    }
  }
}

TEST(Message, is_encoded_as_in_the_worked_examples) {
  EXPECT_EQ(encoded(request_header, "ask"), example_request);
  EXPECT_EQ(encoded(response_header, "answer"), example_response);
  EXPECT_EQ(
      encoded(ResponseHeader{.status = Status::wrong_slave, .session = 7, .sequence = 8, .slave = 9}, ""),
      example_refusal);
}

TEST(Message, is_decoded_as_in_the_worked_examples) {
  const auto request = decode_request(example_request);
  ASSERT_TRUE(request) << to_string(request.error());
  EXPECT_EQ(request->header, request_header);
  EXPECT_EQ(text(request->payload), "ask");
  const auto response = decode_response(example_response);
  ASSERT_TRUE(response) << to_string(response.error());
  EXPECT_EQ(response->header, response_header);
  EXPECT_EQ(text(response->payload), "answer");
  const auto refusal = decode_response(example_refusal);
  ASSERT_TRUE(refusal) << to_string(refusal.error());
  EXPECT_EQ(refusal->header.status, Status::wrong_slave);
  EXPECT_TRUE(refusal->payload.empty());
}

TEST(Message, of_a_header_alone_is_whole_and_one_byte_less_is_too_short) {
  const Bytes empty = encoded(request_header, "");
  ASSERT_EQ(empty.size(), header_bytes);
  EXPECT_TRUE(decode_request(empty));
  EXPECT_EQ(error_of_request(Bytes(empty.begin(), empty.end() - 1)), MessageError::too_short);
  EXPECT_EQ(error_of_request({}), MessageError::too_short);
}

TEST(Message, of_the_other_kind_is_refused) {
  EXPECT_EQ(error_of_request(example_response), MessageError::wrong_magic);
  EXPECT_EQ(decode_response(example_request).error(), MessageError::wrong_magic);
}

TEST(Message, of_another_version_is_refused_although_all_else_is_right) {
  EXPECT_EQ(error_of_request(resealed(altered(example_request, 3, 2))), MessageError::wrong_version);
}

TEST(Message, that_is_not_as_long_as_it_says_is_refused) {
  EXPECT_EQ(error_of_request(resealed(altered(example_request, 32, 2))), MessageError::wrong_length);
  EXPECT_EQ(error_of_request(resealed(altered(example_request, 32, 4))), MessageError::wrong_length);
  EXPECT_EQ(error_of_request(resealed(altered(example_request, 35, 0xFF))), MessageError::wrong_length);
}

TEST(Message, with_a_flag_or_a_status_that_is_not_defined_is_refused) {
  EXPECT_EQ(error_of_request(resealed(altered(example_request, 4, 1))), MessageError::unknown_flags);
  EXPECT_TRUE(decode_response(resealed(altered(example_response, 4, 3))));
  EXPECT_EQ(decode_response(resealed(altered(example_response, 4, 4))).error(), MessageError::unknown_status);
}

TEST(Message, with_any_one_bit_altered_is_refused) {
  for (std::size_t offset = 0; offset < example_request.size(); ++offset) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      Bytes message = example_request;
      message[offset] ^= static_cast<std::byte>(1U << bit);
      EXPECT_FALSE(decode_request(message)) << offset << ", bit " << bit;
    }
  }
}

}  // namespace
}  // namespace protocol::hardened
