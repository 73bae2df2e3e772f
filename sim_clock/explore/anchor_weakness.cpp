#include "sim_clock/explore/anchor_weakness.hpp"

#include <algorithm>
#include <charconv>

namespace ltsim {
namespace {

std::string_view take_word(std::string_view& text) noexcept {
  const std::size_t end = std::min(text.find(' '), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return word;
}

}  // namespace

unsigned anchor_weakness(std::string_view anchor) noexcept {
  static_cast<void>(take_word(anchor));  // the task
  const std::string_view phase = take_word(anchor);
  if (phase != "before" && phase != "in") return 0;
  const std::string_view operation = take_word(anchor);
  const std::string_view object = take_word(anchor);
  constexpr unsigned of_a_kind = 100;  // more than an occurrence adds
  unsigned weakness = 0;
  if (object == "memory") {
    weakness = 4 * of_a_kind;
  } else if (operation == "clock_read" || operation == "sleep" || operation == "yield" ||
             operation == "once") {
    weakness = 3 * of_a_kind;
  } else if (operation == "read" || operation == "write") {
    weakness = 2 * of_a_kind;
  } else if (object.starts_with("mutex-")) {  // named by the order of first use
    weakness = of_a_kind;
  }
  unsigned occurrence = 1;
  if (anchor.starts_with('#')) std::from_chars(anchor.data() + 1, anchor.data() + anchor.size(), occurrence);
  return weakness + std::min(occurrence, of_a_kind) - 1;
}

}  // namespace ltsim
