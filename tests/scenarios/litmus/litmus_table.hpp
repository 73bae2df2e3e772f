// The litmus tests of the literature in variants of memory orders and fences, each with the result that it is about and
// whether C++20 allows that.
#pragma once

#include <span>
#include <string_view>

namespace litmus {

enum class Verdict {
  forbidden,
  allowed,
  allowed_by_load_buffering,  ///< alone: the simulated memory does not show it
};

struct Variant {
  std::string_view name;     ///< "SB/relaxed"
  std::string_view program;  ///< parse()
  std::string_view result;   ///< the one it is about: matches()
  Verdict verdict;
};

[[nodiscard]] std::span<const Variant> variants() noexcept;

}  // namespace litmus
