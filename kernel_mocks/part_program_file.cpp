#include "kernel_mocks/part_program_file.hpp"

#include <array>
#include <filesystem>
#include <fstream>

namespace kernel_mocks {

std::string_view to_string(FileError error) noexcept {
  switch (error) {
    case FileError::cannot_open:
      return "cannot be opened";
    case FileError::cannot_read:
      return "cannot be read";
    case FileError::too_long:
      return "is longer than 64 MiB";
  }
  return "unknown error";
}

tl::expected<std::string, FileError> read_program_file(const std::string& path, std::size_t bytes_max) {
  std::error_code ignored;
  // A folder opens like a file and fails only when it is read.
  if (std::filesystem::is_directory(path, ignored)) return tl::unexpected{FileError::cannot_open};
  std::ifstream file{path, std::ios::binary};
  if (!file) return tl::unexpected{FileError::cannot_open};
  // Piecewise: a pipe or a device has no length that could be asked for.
  std::string text;
  std::array<char, 65536> piece{};
  while (file.read(piece.data(), piece.size()) || file.gcount() > 0) {
    text.append(piece.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > bytes_max) return tl::unexpected{FileError::too_long};
  }
  if (file.bad()) return tl::unexpected{FileError::cannot_read};
  return text;
}

}  // namespace kernel_mocks
