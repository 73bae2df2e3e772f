// The frames of the programming port, as they come: whatever the bytes, each decoder and the receiver end with a value, and
// what they accept has one encoding.

#include <algorithm>

#include "protocol/fx/frame.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

using namespace protocol::fx;

bool are_equal(std::span<const std::byte> one, std::span<const std::byte> other) {
  return std::ranges::equal(one, other);
}

void decode_as_request(std::span<const std::byte> frame) {
  const auto request = decode_request(frame);
  if (!request) return;
  const FrameBytes again = encode(*request);
  ltsim::expect(are_equal(as_span(again), frame), "a request that decodes encodes to the same bytes");
}

void decode_as_reply(std::span<const std::byte> frame) {
  const auto data = decode_data_reply(frame);
  if (!data) return;
  ltsim::expect(!data->empty(), "a reply that decodes holds data");
  const FrameBytes again = encode_data_reply(as_span(*data));
  ltsim::expect(are_equal(as_span(again), frame), "a reply that decodes encodes to the same bytes");
}

void receive_one_by_one(std::span<const std::byte> bytes) {
  FrameReceiver receiver;
  for (const std::byte byte : bytes) {
    if (receiver.receive(byte) != FrameReceiver::Event::frame) continue;
    const auto frame = receiver.frame();
    ltsim::expect(frame.size() <= frame_bytes_max && frame.front() == stx,
                  "a frame received is one, and bounded");
    decode_as_request(frame);
    decode_as_reply(frame);
  }
  ltsim::expect(receiver.skipped_bytes_count() <= bytes.size(), "no byte is skipped twice");
}

}  // namespace

FUZZ_TARGET("fx-frame", {},
            "bytes at the programming port: decoded as a request, as a reply, and one by one") {
  decode_as_request(input);
  decode_as_reply(input);
  receive_one_by_one(input);
}
