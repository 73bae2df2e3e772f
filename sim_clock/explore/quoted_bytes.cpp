#include "sim_clock/explore/quoted_bytes.hpp"

#include <charconv>

#include <fmt/format.h>

namespace ltsim {
namespace {

void append_quoted(std::string& text, char byte) {
  switch (byte) {
    case '"':
      text += "\\\"";
      return;
    case '\\':
      text += "\\\\";
      return;
    case '\n':
      text += "\\n";
      return;
    case '\r':
      text += "\\r";
      return;
    case '\t':
      text += "\\t";
      return;
    default:
      if (byte >= ' ' && byte <= '~') {
        text += byte;
      } else {
        text += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
      }
  }
}

/// Takes one escape off the text, which begins behind its backslash. @return false: it is none
bool take_escape(std::string_view& text, std::string& bytes) {
  if (text.empty()) return false;
  const char letter = text.front();
  text.remove_prefix(1);
  switch (letter) {
    case '"':
    case '\\':
      bytes += letter;
      return true;
    case 'n':
      bytes += '\n';
      return true;
    case 'r':
      bytes += '\r';
      return true;
    case 't':
      bytes += '\t';
      return true;
    case 'x': {
      constexpr std::size_t digits = 2;
      unsigned value = 0;
      if (text.size() < digits) return false;
      const auto [end, error] = std::from_chars(text.data(), text.data() + digits, value, 16);
      if (error != std::errc{} || end != text.data() + digits) return false;
      bytes += static_cast<char>(value);
      text.remove_prefix(digits);
      return true;
    }
    default:
      return false;
  }
}

}  // namespace

std::string quoted(std::string_view bytes) {
  std::string text = "\"";
  for (const char byte : bytes) append_quoted(text, byte);
  return text += '"';
}

tl::expected<std::string, std::string> parse_quoted(std::string_view text) {
  if (!text.starts_with('"')) return tl::unexpected<std::string>("the bytes stand in double quotes");
  text.remove_prefix(1);
  std::string bytes;
  while (!text.empty() && text.front() != '"') {
    const char byte = text.front();
    text.remove_prefix(1);
    if (byte < ' ' || byte > '~') {
      return tl::unexpected(fmt::format("byte {:#04x} is to be written as \\x{:02x}",
                                        static_cast<unsigned char>(byte), static_cast<unsigned char>(byte)));
    }
    if (byte != '\\') {
      bytes += byte;
    } else if (!take_escape(text, bytes)) {
      return tl::unexpected<std::string>(
          "behind a backslash stands one of \" \\ n r t, or x and two hexadecimal digits");
    }
  }
  if (text != "\"")
    return tl::unexpected<std::string>("the bytes end with a double quote, and the line with it");
  return bytes;
}

}  // namespace ltsim
