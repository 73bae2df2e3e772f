// The frames of the programming port, as they come: whatever the bytes, each decoder ends with a value or names the defect
// that the tables name, and what it accepts has one encoding. The receiver has a target of its own (fx_port.cpp).

#include <algorithm>

#include "fuzz/fx_reference_frame.hpp"
#include "protocol/fx/frame.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

using namespace protocol::fx;

bool are_equal(std::span<const std::byte> one, std::span<const std::byte> other) {
  return std::ranges::equal(one, other);
}

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Apart from the decoding, and kept so: most inputs do not come this far, and a sanitizer pays for each byte of a stack frame.
[[gnu::noinline]] void encode_again(const Request& request, std::span<const std::byte> frame) {
  const FrameBytes again = encode(request);
  ltsim::expect(are_equal(as_span(again), frame), "a request that decodes encodes to the same bytes");
}

/// @return whether the envelope is whole: what begins with STX, ends with ETX and the right sum
bool decode_as_request(std::span<const std::byte> frame) {
  const auto request = decode_request(frame);
  const auto defect = fuzz::reference_of_request(text_of(frame)).defect;
  ltsim::expect(request.has_value() != defect.has_value(), "a request decodes if the tables have it");
  if (!request) {
    ltsim::expect(request.error() == *defect, "the first defect of a request is the one that is named");
    return *defect > FrameError::bad_checksum;
  }
  encode_again(*request, frame);
  return true;
}

void decode_as_reply(std::span<const std::byte> frame) {
  const auto data = decode_data_reply(frame);
  const auto defect = fuzz::defect_of_reply(text_of(frame));
  ltsim::expect(data.has_value() != defect.has_value(), "a reply decodes if the tables have it");
  if (!data) {
    ltsim::expect(data.error() == *defect, "the first defect of a reply is the one that is named");
    return;
  }
  const FrameBytes again = encode_data_reply(as_span(*data));
  ltsim::expect(are_equal(as_span(again), frame), "a reply that decodes encodes to the same bytes");
}

}  // namespace

FUZZ_TARGET("fx-frame", {}, "bytes at the programming port: decoded as a request and as a reply") {
  // Most inputs have a wrong sum, and to work it out is most of what a run costs: that a reply is refused for it, too, is
  // left to fx-round-trip.
  if (decode_as_request(input)) decode_as_reply(input);
}
