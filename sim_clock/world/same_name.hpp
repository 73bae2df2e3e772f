// Whether two names are the same. Names are short, and an execution of a microsecond looks up a dozen of them: a call of
// memcmp takes longer than the comparison.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace ltsim {

namespace same_name_parts {

template <typename Word>
[[nodiscard]] inline Word word_at(const char* text) noexcept {
  Word word;
  std::memcpy(&word, text, sizeof word);
  return word;
}

/// Whether two texts begin with the same Word and end with the same Word.
template <typename Word>
[[nodiscard]] inline bool ends_are_same(const char* one, const char* other, std::size_t bytes) noexcept {
  const std::size_t last = bytes - sizeof(Word);
  return ((word_at<Word>(one) ^ word_at<Word>(other)) |
          (word_at<Word>(one + last) ^ word_at<Word>(other + last))) == 0;
}

}  // namespace same_name_parts

[[nodiscard]] inline bool is_same_name(std::string_view one, std::string_view other) noexcept {
  using same_name_parts::ends_are_same;
  const std::size_t bytes = one.size();
  if (bytes != other.size()) return false;
  if (bytes > 2 * sizeof(std::uint64_t)) return one == other;
  if (bytes >= sizeof(std::uint64_t)) return ends_are_same<std::uint64_t>(one.data(), other.data(), bytes);
  if (bytes >= sizeof(std::uint32_t)) return ends_are_same<std::uint32_t>(one.data(), other.data(), bytes);
  for (std::size_t i = 0; i < bytes; ++i) {
    if (one[i] != other[i]) return false;
  }
  return true;
}

}  // namespace ltsim
