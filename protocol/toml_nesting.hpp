// How deep a TOML text nests, asked before a library reads it.
//
// Libraries build nested arrays and tables by recursion and destroy them so, and a dotted key nests a table for each of its
// dots: a line of some kilobytes would end the program by a stack overflow. Of what our programs read, nothing nests deeper
// than three levels.
//
// Only brackets, dots, strings and comments are looked at: what is no TOML otherwise is the library's to refuse. Up to the first
// mistake, at which a library stops, both see the same strings and comments.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace protocol {

/// Brackets within brackets, and parts of a dotted key.
inline constexpr unsigned toml_nesting_max = 8;

struct TomlPlace {
  std::uint32_t line = 1;    ///< from 1
  std::uint32_t column = 1;  ///< a byte of its line, from 1

  bool operator==(const TomlPlace&) const = default;
};

/// @return the first bracket or dot that is one too many; nothing if there is none
[[nodiscard]] std::optional<TomlPlace> too_deep_nesting(std::string_view toml) noexcept;

}  // namespace protocol
