#include "sim_clock/explore/same_failure.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "sim_clock/explore/explorer.hpp"

namespace ltsim {
namespace {

constexpr std::string_view blanks = " \t\n";

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// What it takes to make the failure happen, sorted; where and for how long does not matter.
std::vector<std::pair<Deviation::Kind, FaultKind>> means_of(const Schedule& schedule) {
  std::vector<std::pair<Deviation::Kind, FaultKind>> means;
  for (const Deviation& deviation : schedule.deviations) {
    const bool is_slow =
        deviation.kind == Deviation::Kind::pass_time;  // that, or a stall, often does equally
    means.emplace_back(is_slow ? Deviation::Kind::stall : deviation.kind, deviation.fault);
  }
  std::sort(means.begin(), means.end());
  return means;
}

}  // namespace

bool same_failure(const Outcome& outcome, const Schedule& schedule) {
  return outcome.kind == schedule.outcome && one_line(outcome.message) == schedule.message;
}

bool alike_failure(const Outcome& outcome, const Schedule& schedule) {
  return outcome.kind == schedule.outcome &&
         (one_line(outcome.message) == schedule.message ||
          without_numbers(outcome.message) == without_numbers(schedule.message));
}

bool is_known_message(const Failure& failure, std::string_view message) {
  constexpr std::size_t messages_max = 16;
  if (std::find(failure.messages.begin(), failure.messages.end(), message) != failure.messages.end())
    return true;
  return failure.messages.size() >= messages_max &&
         without_numbers(failure.messages.front()) == without_numbers(message);
}

bool is_same_failure(const Failure& one, const Failure& other) {
  if (one.outcome == other.outcome) return true;
  if (one.outcome.kind != other.outcome.kind ||
      without_numbers(one.outcome.message) != without_numbers(other.outcome.message))
    return false;
  const auto means = means_of(one.schedule);
  const auto other_means = means_of(other.schedule);
  return std::includes(means.begin(), means.end(), other_means.begin(), other_means.end()) ||
         std::includes(other_means.begin(), other_means.end(), means.begin(), means.end());
}

std::string without_numbers(std::string_view message) {
  std::string text;
  while (!message.empty()) {
    const std::size_t end = std::min(message.find_first_of(blanks), message.size());
    std::string_view word = message.substr(0, end);
    message.remove_prefix(std::min(end + 1, message.size()));
    const std::size_t begin = std::min(word.find_first_not_of("([{\"'+-=<>"), word.size());
    text += word.substr(0, begin);
    word.remove_prefix(begin);
    if (!word.empty() && is_digit(word.front())) {
      // The number with its unit, or in base 16; what follows it, such as a comma, stays.
      const std::size_t number_end = std::min(word.find_first_of(",;:)]}\"'!?"), word.size());
      text += '#';
      word.remove_prefix(number_end);
    }
    text += word;
    text += ' ';
  }
  return text;
}

}  // namespace ltsim
