// Whether two names are the same. Names are short, and an execution of a microsecond looks up a dozen of them: a call of
// memcmp takes longer than the comparison.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace ltsim {

[[nodiscard]] inline bool is_same_name(std::string_view one, std::string_view other) noexcept {
  if (one.size() != other.size()) return false;
  constexpr std::size_t piece = sizeof(std::uint64_t);  // of a fixed size the comparison is no call
  std::size_t at = 0;
  for (; at + piece <= one.size(); at += piece) {
    if (std::memcmp(one.data() + at, other.data() + at, piece) != 0) return false;
  }
  for (; at < one.size(); ++at) {
    if (one[at] != other[at]) return false;
  }
  return true;
}

}  // namespace ltsim
