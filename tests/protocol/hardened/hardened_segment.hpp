// A segment of the hardened handoff that no other test uses.
#pragma once

#include <chrono>
#include <string>

#include "protocol/hardened/endpoint.hpp"
#include "protocol/hardened/state_word.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol::hardened {

/// Its named objects are removed at the end of the test, unless somebody still plays a role.
class HardenedSegment {
 public:
  HardenedSegment() = default;
  HardenedSegment(const HardenedSegment&) = delete;
  HardenedSegment& operator=(const HardenedSegment&) = delete;
  ~HardenedSegment() { static_cast<void>(remove_segment(name())); }

  [[nodiscard]] const std::string& name() const noexcept { return name_.name(); }
  [[nodiscard]] StateWord word() const { return decode(RawSegment(name()).word(0)); }
  void set_word(const StateWord& word) const { RawSegment(name()).set_word(0, encode(word)); }

 private:
  TestSegment name_;
};

/// Payloads of at most eight bytes, and a master that looks once and does not wait: the request length lies at 4, its
/// bytes at 8, the response length at 56, its bytes at 60, and the end at 108.
[[nodiscard]] inline Options impatient() {
  Options options;
  options.request_bytes_max = 8;
  options.response_bytes_max = 8;
  options.take_timeout = std::chrono::nanoseconds::zero();
  options.answer_timeout = std::chrono::nanoseconds::zero();
  return options;
}

inline constexpr std::size_t request_length_offset = 4;
inline constexpr std::size_t request_offset = 8;
inline constexpr std::size_t response_length_offset = 56;
inline constexpr std::size_t response_offset = 60;

}  // namespace protocol::hardened
