// A segment name that no other test uses, and the raw memory behind it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <boost/interprocess/mapped_region.hpp>

#include "protocol/paper_options.hpp"

namespace protocol {

/// Unique on this machine while the process lives; its named objects are removed at both ends of the test.
class TestSegment {
 public:
  TestSegment();
  TestSegment(const TestSegment&) = delete;
  TestSegment& operator=(const TestSegment&) = delete;
  ~TestSegment();

  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  std::string name_;
};

/// The segment as bytes, mapped without the wrappers: what a test compares their doings with.
class RawSegment {
 public:
  explicit RawSegment(const std::string& name);

  [[nodiscard]] std::size_t size_bytes() const noexcept { return memory_.get_size(); }
  [[nodiscard]] std::uint32_t word(std::size_t offset) const noexcept;
  void set_word(std::size_t offset, std::uint32_t value) noexcept;
  [[nodiscard]] std::string text(std::size_t offset, std::size_t length_bytes) const;
  void set_text(std::size_t offset, std::string_view text) noexcept;

 private:
  boost::interprocess::mapped_region memory_;
};

/// Consumes every token of the segment's semaphore.
/// @return how many there were
unsigned take_all_tokens(const std::string& segment_name);

/// Areas of eight bytes, and a master that looks once and does not wait: so the request length lies at 4, its
/// bytes at 8, the response length at 16, its bytes at 20, and the end at 28.
[[nodiscard]] PaperOptions small_options();

[[nodiscard]] std::vector<std::byte> bytes(std::string_view text);
[[nodiscard]] std::string text(std::span<const std::byte> bytes);

}  // namespace protocol
