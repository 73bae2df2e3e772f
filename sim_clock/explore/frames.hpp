// Messages between processes as bytes: a 32-bit length in the host's byte order, and so many bytes. A process that dies while it
// writes leaves a part of one behind: such a part is ignored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ltsim {

[[nodiscard]] std::vector<std::uint8_t> as_frame(std::span<const std::uint8_t> bytes);

/// Waits until all is written. @return false: nobody reads it
bool write_all(int descriptor, std::span<const std::uint8_t> bytes) noexcept;

/// Puts frames together again, from whatever pieces arrive.
class FrameReader {
 public:
  void add(std::span<const std::uint8_t> bytes) { buffer_.insert(buffer_.end(), bytes.begin(), bytes.end()); }
  /// @return the next whole one, without its length, if it has arrived
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> next();

 private:
  std::vector<std::uint8_t> buffer_;
};

bool write_text(int descriptor, std::string_view text);
/// Waits for it. @return none: nobody writes any more
[[nodiscard]] std::optional<std::string> read_text(int descriptor, FrameReader& reader);

}  // namespace ltsim
