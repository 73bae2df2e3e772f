// Any bytes as one line of readable text: "\x02010F604\x0374".
//
// Printable ASCII stands as it is, but for \" and \\; \n, \r and \t have their letters; all else is \x and two lower-case
// hexadecimal digits. One text for each string of bytes.
#pragma once

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace ltsim {

/// With the quotes.
[[nodiscard]] std::string quoted(std::string_view bytes);
/// Reads what quoted() writes; upper-case digits, too.
/// @return the bytes; or what is wrong, for a message
[[nodiscard]] tl::expected<std::string, std::string> parse_quoted(std::string_view text);

}  // namespace ltsim
