// Reads the text of a part program from a file. Apart from the parser, which takes text from anywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace kernel_mocks {

/// Longest part program file: 64 MiB.
inline constexpr std::size_t program_bytes_max = std::size_t{64} * 1024 * 1024;

enum class FileError : std::uint8_t {
  cannot_open,  ///< no such file, a folder, or no permission
  cannot_read,  ///< it opened and then failed
  too_long,     ///< more than program_bytes_max
};

[[nodiscard]] std::string_view to_string(FileError error) noexcept;

/// @param bytes_max  limit for the file's length
[[nodiscard]] tl::expected<std::string, FileError> read_program_file(
    const std::string& path, std::size_t bytes_max = program_bytes_max);

}  // namespace kernel_mocks
