#include "property_tests/protocol/fx/generated_frames.hpp"

#include <ostream>

#include "sim_clock/explore/quoted_bytes.hpp"

namespace protocol::fx {

void showValue(const Request& request, std::ostream& out) {
  const FrameBytes frame = encode(request);
  out << ltsim::quoted(property_tests::text_of(as_span(frame)));
}

}  // namespace protocol::fx

namespace property_tests {

using namespace protocol::fx;

namespace {

constexpr int bytes_count = 256;

DataBytes generated_data(std::size_t count) {
  DataBytes data;
  for (const int byte : *rc::gen::container<std::vector<int>>(count, rc::gen::inRange(0, bytes_count)))
    data.push_back(static_cast<std::byte>(byte));
  return data;
}

}  // namespace

rc::Gen<Request> any_request() {
  return rc::gen::exec([] {
    using enum Command;
    Request request;
    request.command = *rc::gen::element(read, write, force_on, force_off, read_wide, write_wide,
                                        force_on_wide, force_off_wide);
    request.address = *rc::gen::arbitrary<std::uint16_t>();
    const bool writes = request.command == write || request.command == write_wide;
    if (!writes && request.command != read && request.command != read_wide) return request;
    const std::size_t most = is_wide(request.command) ? data_bytes_max_wide : data_bytes_max_legacy;
    request.count_bytes = static_cast<std::uint8_t>(*rc::gen::inRange<std::size_t>(1, most + 1));
    if (writes) request.data = generated_data(request.count_bytes);
    return request;
  });
}

rc::Gen<std::string> any_frame() {
  return rc::gen::exec([] {
    if (*rc::gen::arbitrary<bool>()) return text_of(as_span(encode(*any_request())));
    const DataBytes data = generated_data(*rc::gen::inRange<std::size_t>(1, data_bytes_max_wide + 1));
    return text_of(as_span(encode_data_reply(as_span(data))));
  });
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span{text}); }

}  // namespace property_tests
