#include "sim_clock/scenario/shape.hpp"

#include <algorithm>

namespace ltsim {
namespace {

std::vector<Shape>& registry() {
  static std::vector<Shape> all;
  return all;
}

}  // namespace

bool Shape::is_finding(const Outcome& outcome) const noexcept {
  if (outcome.kind != OutcomeKind::invariant) return to_string(outcome.kind) == facts.finding;
  const std::string_view message = outcome.message;
  // "I1" is not the beginning of "I18: ...".
  return message.starts_with(facts.finding) && message.substr(facts.finding.size()).find_first_of(":,") == 0;
}

const std::vector<Shape>& shapes() { return registry(); }

const Shape* find_shape(std::string_view name) {
  const auto found =
      std::find_if(registry().begin(), registry().end(), [&](const Shape& s) { return s.name == name; });
  return found == registry().end() ? nullptr : &*found;
}

ShapeRegistration::ShapeRegistration(std::string_view name, std::string_view corrected_name,
                                     const ShapeFacts& facts, std::string_view description,
                                     void (*open)(World&), void (*corrected)(World&)) {
  const ScenarioRegistration fails{name, description, open};
  const ScenarioRegistration holds{corrected_name, facts.cure, corrected};
  auto& all = registry();
  const auto place = std::lower_bound(all.begin(), all.end(), name,
                                      [](const Shape& s, std::string_view n) { return s.name < n; });
  all.insert(place, Shape{.name = name, .corrected_name = corrected_name, .facts = facts});
}

}  // namespace ltsim
