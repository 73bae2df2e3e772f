// How an exploration is told: as text for a person, as JSON for a program, as JUnit's XML for a CI server.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/explore/explorer.hpp"

namespace ltsim {

/// The exploration of one scenario, with what became of it.
struct ScenarioReport {
  std::string_view scenario;
  std::string strategy;
  std::uint64_t seed = 0;
  ExploreReport explored;
  /// Of each failure, where its schedule lies; empty if it has none or it could not be written.
  std::vector<std::string> schedule_paths;
  std::optional<std::string> error;  ///< why the exploration ended early, if not for a failure
};

/// The failure as a person wants it: what broke, and the choices that lead to it.
[[nodiscard]] std::string describe(const Failure& failure, std::string_view strategy);

/// Schema "ltsim.explore/1": one object for one scenario, an array of them for several.
///
/// A failure whose schedule could not be written has "schedule": null and the file's text as "schedule_text";
/// one whose process died has no schedule: null. "error" is there if there was one.
[[nodiscard]] std::string to_json(const std::vector<ScenarioReport>& reports);

/// One testsuite for each scenario; in it one testcase, or one for each different failure.
[[nodiscard]] std::string to_junit(const std::vector<ScenarioReport>& reports);

/// `text` for XML 1.0, within an attribute or an element: what XML cannot hold at all is replaced by '?'.
[[nodiscard]] std::string as_xml(std::string_view text);

}  // namespace ltsim
