#include "emulator_models/programs/interlock_rules.hpp"

#include <algorithm>

namespace emulator_models {
namespace {

constexpr std::string_view mark = "(* rule: ";
constexpr std::string_view mark_end = " *)";

/// The name at the end of a line, or nothing.
std::string_view rule_of(std::string_view line) noexcept {
  const std::size_t begin = line.rfind(mark);
  if (begin == std::string_view::npos) return {};
  const std::string_view name = line.substr(begin + mark.size());
  return name.substr(0, name.find(mark_end));
}

template <typename Visitor>
void for_each_line(std::string_view source, Visitor visit) {
  while (!source.empty()) {
    const std::size_t end = std::min(source.find('\n'), source.size());
    visit(source.substr(0, end));
    source.remove_prefix(std::min(end + 1, source.size()));
  }
}

}  // namespace

std::vector<std::string> rules_of(std::string_view source) {
  std::vector<std::string> rules;
  for_each_line(source, [&](std::string_view line) {
    const std::string_view rule = rule_of(line);
    if (!rule.empty() && std::ranges::find(rules, rule) == rules.end()) rules.emplace_back(rule);
  });
  return rules;
}

std::string without_rule(std::string_view source, std::string_view name) {
  std::string result;
  for_each_line(source, [&](std::string_view line) {
    if (rule_of(line) != name) result += line;
    result += '\n';
  });
  return result;
}

}  // namespace emulator_models
