// Any request and any reply, the wrong ones too, there and back.
//
// The input is taken twice: as fields of which a request and a reply are made, and as a frame. Its mutator makes frames.
//
//   byte   0        1, 2     3            4...
//          command  address  count_bytes  data
//
// What is encoded decodes to itself, or is refused for the defect that the tables name; what decodes is encoded to the same
// bytes.

#include <algorithm>

#include "fuzz/fx_frame_mutator.hpp"
#include "fuzz/fx_reference_frame.hpp"
#include "protocol/fx/frame.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

using namespace protocol::fx;

constexpr unsigned commands_count = static_cast<unsigned>(Command::force_off_wide) + 1;

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_write(Command command) { return command == Command::write || command == Command::write_wide; }
bool is_read(Command command) { return command == Command::read || command == Command::read_wide; }

std::string letters_of(Command command) {
  constexpr std::string_view letters[] = {"0", "1", "7", "8", "E00", "E10", "E7", "E8"};
  return std::string{letters[static_cast<unsigned>(command)]};
}

/// The payload as the tables write it down.
std::string payload_of(const Request& request) {
  const unsigned high = request.address / 256U;
  const unsigned low = request.address % 256U;
  std::string payload = letters_of(request.command);
  const bool is_force = !is_read(request.command) && !is_write(request.command);
  payload += fuzz::hexadecimal(is_force ? low : high, 2) + fuzz::hexadecimal(is_force ? high : low, 2);
  if (!is_force) payload += fuzz::hexadecimal(request.count_bytes, 2);
  for (const std::byte byte : request.data) payload += fuzz::hexadecimal(std::to_integer<unsigned>(byte), 2);
  return payload;
}

/// @param fields  at least four
Request request_of(std::span<const std::byte> fields) {
  Request request;
  request.command = static_cast<Command>(std::to_integer<unsigned>(fields[0]) % commands_count);
  request.address = static_cast<std::uint16_t>(std::to_integer<unsigned>(fields[1]) * 256U +
                                               std::to_integer<unsigned>(fields[2]));
  const bool is_force = !is_read(request.command) && !is_write(request.command);
  if (is_force) return request;
  request.count_bytes = std::to_integer<std::uint8_t>(fields[3]);
  if (is_read(request.command)) return request;
  const auto data = fields.subspan(4, std::min(fields.size() - 4, data_bytes_max_wide));
  request.data.assign(data.begin(), data.end());
  return request;
}

void encode_and_decode_request(const Request& request) {
  const FrameBytes frame = encode(request);
  const std::string_view text = text_of(as_span(frame));
  ltsim::expect(text == fuzz::framed(payload_of(request)), "a request is encoded as the tables say");
  const auto again = decode_request(as_span(frame));
  const auto defect = fuzz::reference_of_request(text).defect;
  if (defect) {
    ltsim::expect(!again && again.error() == *defect, "a wrong request is refused for what is wrong");
  } else {
    ltsim::expect(again && *again == request, "a right request decodes to itself");
  }
}

void encode_and_decode_reply(std::span<const std::byte> data) {
  const FrameBytes frame = encode_data_reply(data);
  std::string payload;
  for (const std::byte byte : data.first(std::min(data.size(), data_bytes_max_wide)))
    payload += fuzz::hexadecimal(std::to_integer<unsigned>(byte), 2);
  ltsim::expect(text_of(as_span(frame)) == fuzz::framed(payload), "a reply is encoded as the tables say");
  const auto again = decode_data_reply(as_span(frame));
  if (data.empty()) {
    ltsim::expect(!again && again.error() == FrameError::bad_count, "a reply without data is refused");
  } else {
    ltsim::expect(again && std::ranges::equal(*again, data.first(again->size())) &&
                      again->size() == std::min(data.size(), data_bytes_max_wide),
                  "a reply decodes to itself");
  }
}

void decode_and_encode(std::span<const std::byte> frame) {
  const auto request = decode_request(frame);
  const auto expected = fuzz::reference_of_request(text_of(frame));
  ltsim::expect(request.has_value() != expected.defect.has_value(),
                "a request decodes if the tables have it");
  if (request) {
    ltsim::expect(request->address == expected.address && request->count_bytes == expected.count_bytes &&
                      2 * request->data.size() == expected.digits.size(),
                  "a request decodes to what the tables say");
    ltsim::expect(text_of(as_span(encode(*request))) == text_of(frame),
                  "a request that decodes encodes to the same bytes");
  } else {
    ltsim::expect(request.error() == *expected.defect, "the first defect of a request is the one named");
    ltsim::expect(!to_string(request.error()).empty(), "a defect has words");
  }
  const auto reply = decode_data_reply(frame);
  const auto defect = fuzz::defect_of_reply(text_of(frame));
  ltsim::expect(reply.has_value() != defect.has_value(), "a reply decodes if the tables have it");
  if (reply) {
    ltsim::expect(text_of(as_span(encode_data_reply(as_span(*reply)))) == text_of(frame),
                  "a reply that decodes encodes to the same bytes");
  } else {
    ltsim::expect(reply.error() == *defect, "the first defect of a reply is the one named");
  }
}

}  // namespace

FUZZ_TARGET("fx-round-trip", {.split = fuzz::frames_as_records, .mutate = fuzz::mutate_frame},
            "a request and a reply made of the bytes, encoded and decoded; the bytes decoded and encoded") {
  decode_and_encode(input);
  constexpr std::size_t fields_count = 4;
  if (input.size() < fields_count) return;
  encode_and_decode_request(request_of(input));
  encode_and_decode_reply(input.subspan(fields_count));
}
