// Requests and frames of the programming port, for properties.
#pragma once

#include <iosfwd>
#include <string>

#include <rapidcheck.h>

#include "protocol/fx/frame.hpp"

namespace protocol::fx {

/// As its frame, quoted.
void showValue(const Request& request, std::ostream& out);

}  // namespace protocol::fx

namespace property_tests {

/// One that decodes.
[[nodiscard]] rc::Gen<protocol::fx::Request> any_request();
/// Of a request or a reply, as it travels.
[[nodiscard]] rc::Gen<std::string> any_frame();

[[nodiscard]] std::string text_of(std::span<const std::byte> bytes);
[[nodiscard]] std::span<const std::byte> bytes_of(const std::string& text);

}  // namespace property_tests
