// The scenarios of the published handoff, and what each is there to show.
//
// The name of a hazard's scenario begins with the hazard's number in protocol/README.md, and it differs from
// the sound exchange in what the hazard needs, and in nothing else. What it shows is for tests and tables: the
// search does not know it.
#pragma once

#include <span>
#include <string_view>

#include "tests/scenarios/paper_exchange.hpp"

namespace scenarios {

struct PaperScenario {
  std::string_view name;
  std::string_view description;
  /// What the hazard is known by: an invariant that the message names, "I4"; or, where that would not tell it
  /// from another hazard, the beginning of the message. Empty: the exchange is sound.
  std::string_view shows;
  PaperExchange exchange;
};

[[nodiscard]] std::span<const PaperScenario> paper_scenarios();

/// Whether a failure with this message is what the scenario is there to show.
[[nodiscard]] bool is_shown_by(const PaperScenario& scenario, std::string_view message);

}  // namespace scenarios
