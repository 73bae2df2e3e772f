// What the targets of text have in common: the text of an input, and the places that a refusal may name.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fuzz {

[[nodiscard]] inline std::string_view text_of(std::span<const std::byte> input) noexcept {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

/// Behind the last line feed there is a line, too, if an empty one.
/// @param number  from 1
/// @return        the line without its line feed; nothing if the text has not so many
[[nodiscard]] inline std::optional<std::string_view> line_of(std::string_view text, std::size_t number) {
  if (number == 0) return std::nullopt;
  while (--number > 0) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find('\n'));
}

/// @param line, column  from 1
/// @return              whether that is a byte of the text, or where the text ends: toml++ counts the line feed at the end as a
///                      column and stays in its line
[[nodiscard]] inline bool is_inside(std::string_view text, std::size_t line, std::size_t column) {
  const auto found = line_of(text, line);
  if (!found || column == 0) return false;
  const bool is_last = text.ends_with('\n') && found->data() + found->size() + 1 == text.data() + text.size();
  return column <= found->size() + (is_last ? 2 : 1);
}

/// Upper case for lower case, and the other way round.
[[nodiscard]] inline std::string with_cases_swapped(std::string_view text) {
  std::string swapped{text};
  for (char& c : swapped) {
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) c = static_cast<char>(c ^ 0x20);
  }
  return swapped;
}

}  // namespace fuzz
