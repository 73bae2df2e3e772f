// Frames of the programming port: there is one encoding of each value, and nothing that was damaged is taken for it.

#include "property_tests/protocol/fx/generated_frames.hpp"
#include "property_tests/support/property.hpp"

namespace property_tests {
namespace {

using namespace protocol::fx;

/// Refused, or the one encoding of what it decodes to.
void assert_refused_or_canonical(const std::string& frame) {
  if (const auto request = decode_request(bytes_of(frame)))
    RC_ASSERT(text_of(as_span(encode(*request))) == frame);
  if (const auto data = decode_data_reply(bytes_of(frame)))
    RC_ASSERT(text_of(as_span(encode_data_reply(as_span(*data)))) == frame);
}

char changed(char byte, int by) { return static_cast<char>(static_cast<unsigned char>(byte) ^ by); }

rc::Gen<int> any_change() { return rc::gen::inRange(1, 256); }

PROPERTY(FxFrame, a_request_that_was_encoded_decodes_to_itself, ()) {
  const Request sent = *any_request();
  const auto received = decode_request(as_span(encode(sent)));
  RC_ASSERT(received.has_value());
  RC_ASSERT(*received == sent);
}

PROPERTY(FxFrame, data_that_were_encoded_decode_to_themselves, (const std::string& text)) {
  RC_PRE(!text.empty() && text.size() <= data_bytes_max_wide);
  const auto received = decode_data_reply(as_span(encode_data_reply(bytes_of(text))));
  RC_ASSERT(received.has_value());
  RC_ASSERT(text_of(as_span(*received)) == text);
}

// The sum finds any one byte that has changed: it covers all but STX and itself, which have one right value.
PROPERTY(FxFrame, with_any_one_byte_damaged_is_refused, ()) {
  const std::string frame = *any_frame();
  const int by = *any_change();
  for (std::size_t i = 0; i < frame.size(); ++i) {
    std::string damaged = frame;
    damaged[i] = changed(damaged[i], by);
    const FuzzInput input{"fx-frame", {damaged}};
    RC_ASSERT(!decode_request(bytes_of(damaged)));
    RC_ASSERT(!decode_data_reply(bytes_of(damaged)));
  }
}

/// STX, the payload, ETX and the sum that belongs to it.
std::string closed(const std::string& payload) {
  unsigned sum = 3;
  for (const char byte : payload) sum += static_cast<unsigned char>(byte);
  constexpr const char* digits = "0123456789ABCDEF";
  return '\x02' + payload + '\x03' + digits[sum / 16 % 16] + digits[sum % 16];
}

// Damage that the sum does not see makes another frame, with one encoding of its own.
PROPERTY(FxFrame, damaged_with_a_right_sum_is_refused_or_is_another_frame, ()) {
  const std::string frame = *any_frame();
  std::string payload = frame.substr(1, frame.size() - 4);
  const auto damages_count = *rc::gen::inRange<std::size_t>(1, 4);
  for (std::size_t i = 0; i < damages_count; ++i) {
    char& byte = payload[*rc::gen::inRange<std::size_t>(0, payload.size())];
    byte = *rc::gen::oneOf(rc::gen::map(any_change(), [was = byte](int by) { return changed(was, by); }),
                           rc::gen::elementOf(std::string{"0123456789ABCDEFabcdef\x02\x03"}));
  }
  const FuzzInput input{"fx-frame", {closed(payload)}};
  assert_refused_or_canonical(closed(payload));
}

PROPERTY(FxFrame, of_any_payload_is_refused_or_canonical, ()) {
  const std::string letters =
      *rc::gen::element<std::string>("", "0", "1", "7", "8", "E00", "E10", "E7", "E8");
  const auto digits =
      *rc::gen::container<std::string>(rc::gen::elementOf(std::string{"0123456789ABCDEF0000a\x03"}));
  const std::string frame = closed(letters + digits);
  const FuzzInput input{"fx-frame", {frame}};
  assert_refused_or_canonical(frame);
}

// As protocol/fx/README.md has it: 64 bytes at most by the commands 0 and 1, 254 by E00 and E10, and never none.
PROPERTY(FxFrame, with_a_count_is_taken_from_one_up_to_the_limit_of_its_command, ()) {
  const bool wide = *rc::gen::arbitrary<bool>();
  const bool writes = *rc::gen::arbitrary<bool>();
  const unsigned limit = wide ? 254 : 64;
  const unsigned count =
      *rc::gen::oneOf(rc::gen::inRange(0U, 256U), rc::gen::element(0U, 1U, limit, limit + 1));
  constexpr const char* digits = "0123456789ABCDEF";
  std::string payload = wide ? (writes ? "E10" : "E00") : (writes ? "1" : "0");
  payload += std::string{"1000"} + digits[count / 16] + digits[count % 16];
  if (writes) payload += std::string(2 * std::size_t{count}, '5');
  const FuzzInput input{"fx-frame", {closed(payload)}};
  RC_ASSERT(decode_request(bytes_of(closed(payload))).has_value() == (count >= 1 && count <= limit));
}

using Event = FrameReceiver::Event;

/// A piece of what comes over the line, and what the receiver says to it.
struct LinePiece {
  std::string bytes;
  Event event;
  std::size_t skipped = 0;
};

void showValue(const LinePiece& piece, std::ostream& out) { rc::show(piece.bytes, out); }

/// Any but STX, ENQ, ACK and NAK.
rc::Gen<std::string> noise() {
  return rc::gen::nonEmpty(
      rc::gen::container<std::string>(rc::gen::suchThat(rc::gen::arbitrary<char>(), [](char c) {
        return std::string{"\x02\x05\x06\x15"}.find(c) == std::string::npos;
      })));
}

rc::Gen<LinePiece> any_piece() {
  return rc::gen::exec([] {
    switch (*rc::gen::inRange(0, 5)) {
      case 0:
        return LinePiece{*any_frame(), Event::frame};
      case 1:
        return LinePiece{"\x05", Event::enq_received};
      case 2:
        return LinePiece{"\x06", Event::ack_received};
      case 3:
        return LinePiece{"\x15", Event::nak_received};
      default: {
        const std::string bytes = *noise();
        return LinePiece{bytes, Event::none, bytes.size()};
      }
    }
  });
}

PROPERTY(FxFrameReceiver, finds_each_frame_among_noise_wherever_the_line_is_cut_and_goes_on, ()) {
  const auto pieces = *rc::gen::container<std::vector<LinePiece>>(any_piece());
  const auto bytes_until_copy = *rc::gen::inRange<std::size_t>(1, 40);
  FrameReceiver receiver;
  std::size_t skipped = 0;
  std::size_t received = 0;
  std::vector<std::string> records;
  for (const LinePiece& piece : pieces) records.push_back(piece.bytes);
  const FuzzInput input{"fx-frame", records};
  for (const LinePiece& piece : pieces) {
    for (std::size_t i = 0; i < piece.bytes.size(); ++i) {
      const Event event = receiver.receive(static_cast<std::byte>(piece.bytes[i]));
      const bool is_last = i + 1 == piece.bytes.size();
      RC_ASSERT(static_cast<int>(event) == static_cast<int>(is_last ? piece.event : Event::none));
      if (++received % bytes_until_copy == 0) receiver = FrameReceiver{receiver};
      RC_ASSERT(receiver.in_frame() == (piece.event == Event::frame && !is_last));
    }
    if (piece.event == Event::frame) RC_ASSERT(text_of(receiver.frame()) == piece.bytes);
    skipped += piece.skipped;
    RC_ASSERT(receiver.skipped_bytes_count() == skipped);
  }
}

// Torn off by STX, by ENQ, or by a silence.
PROPERTY(FxFrameReceiver, a_frame_torn_off_leaves_nothing_behind, ()) {
  const std::string torn = *any_frame();
  const auto length = *rc::gen::inRange<std::size_t>(1, torn.size());
  const std::string next = *any_frame();
  const auto way = *rc::gen::element('s', 'e', 'r');
  FrameReceiver receiver;
  for (std::size_t i = 0; i < length; ++i)
    RC_ASSERT(receiver.receive(static_cast<std::byte>(torn[i])) == Event::none);
  if (way == 'e') RC_ASSERT(receiver.receive(enq) == Event::enq_received);
  if (way == 'r') RC_ASSERT(receiver.reset());
  for (std::size_t i = 0; i < next.size(); ++i) {
    const Event event = receiver.receive(static_cast<std::byte>(next[i]));
    RC_ASSERT((event == Event::frame) == (i + 1 == next.size()));
  }
  RC_ASSERT(text_of(receiver.frame()) == next);
  RC_ASSERT(receiver.skipped_bytes_count() == 0U);
}

}  // namespace
}  // namespace property_tests
