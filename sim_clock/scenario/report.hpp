// How an exploration is told: as text for a person, as JSON for a program.
#pragma once

#include <string>
#include <string_view>

#include "sim_clock/explore/explorer.hpp"

namespace ltsim {

/// The failure as a person wants it: what broke, the schedule, and last the line that shows it again.
/// @param replay_line  e.g. "ltsim replay out/paper-time-out.schedule"
[[nodiscard]] std::string describe(const Failure& failure, std::string_view strategy,
                                   std::string_view replay_line);

struct JsonReport {
  std::string_view scenario;
  std::string_view strategy;
  std::uint64_t seed;
  const ExploreReport& report;
  const std::vector<std::string>& schedule_paths;  ///< one for each failure
};

/// One object, schema "ltsim.explore/1".
[[nodiscard]] std::string to_json(const JsonReport& report);

}  // namespace ltsim
