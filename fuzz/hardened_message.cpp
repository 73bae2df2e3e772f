// The messages of the hardened handoff, against a second decoder.
//
//   byte   0          bit 0: a response instead of a request; bit 1: the right checksum is put in place before
//   from   1          the message, as it might lie in an area

#include <algorithm>
#include <vector>

#include "fuzz/hardened_reference.hpp"
#include "protocol/hardened/message.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

namespace hardened = protocol::hardened;
namespace reference = fuzz::reference;

reference::Message plain(const hardened::Request& request) {
  return {.session = request.header.session,
          .sequence = request.header.sequence,
          .slave = request.header.expected_slave,
          .payload = {request.payload.begin(), request.payload.end()}};
}

reference::Message plain(const hardened::Response& response) {
  return {.flags_or_status = static_cast<std::uint32_t>(response.header.status),
          .session = response.header.session,
          .sequence = response.header.sequence,
          .slave = response.header.slave,
          .payload = {response.payload.begin(), response.payload.end()}};
}

/// @param decoded  by the code under test
template <typename Decoded>
void compare(reference::Kind kind, std::span<const std::byte> bytes, const Decoded& decoded) {
  reference::Message expected;
  const auto defect = reference::decode(kind, bytes, expected);
  ltsim::expect(decoded.has_value() != defect.has_value(), "what decodes is whole, and the other way round");
  if (!decoded) {
    ltsim::expect(decoded.error() == *defect, "the first defect is told");
    ltsim::expect(!to_string(decoded.error()).empty(), "a defect has words");
    return;
  }
  ltsim::expect(plain(*decoded) == expected, "each field is the one of the message");
  std::vector<std::byte> room(bytes.size());
  ltsim::expect(std::ranges::equal(encode(decoded->header, decoded->payload, room), bytes),
                "what decodes encodes to the same bytes");
}

}  // namespace

FUZZ_TARGET("hardened-message", {}, "a message of the hardened handoff, decoded and encoded again") {
  if (input.empty()) return;
  const auto how = std::to_integer<unsigned>(input.front());
  std::vector<std::byte> bytes(input.begin() + 1, input.end());
  if ((how & 2U) != 0) reference::seal(bytes);
  if ((how & 1U) != 0) {
    compare(reference::Kind::response, bytes, hardened::decode_response(bytes));
  } else {
    compare(reference::Kind::request, bytes, hardened::decode_request(bytes));
  }
}
