// What both sides do in the tests of real threads and processes, whichever handoff is between them.
#pragma once

#include <array>
#include <span>
#include <string>

#include "protocol/exchange_sides.hpp"
#include "protocol/serial_port.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol {

inline void answer_until_stopped(ExchangeSlave& slave) {
  while (slave.wait_for_request()) slave.write_response(bytes("answer to " + text(slave.read_request())));
}

/// @return the first request that got another answer than its own, or -1
[[nodiscard]] inline int ask_in_turn(SerialPort& port, int requests_count) {
  for (int number = 0; number < requests_count; ++number) {
    const std::string request = "request " + std::to_string(number);
    std::array<std::byte, 64> buffer{};
    if (!port.write(bytes(request))) return number;
    const auto count = port.read(buffer);
    if (!count || text(std::span(buffer).first(*count)) != "answer to " + request) return number;
  }
  return -1;
}

}  // namespace protocol
